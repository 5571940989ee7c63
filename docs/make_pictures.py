# Puts the demo's pictures of the bunny side by side for the README: run scripts/demo.sh, then
# .venv/bin/python docs/make_pictures.py
# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes docs/pipeline.png from out/bunny_{cloud,lines,mesh}.png."""

from pathlib import Path

from PIL import Image

checkout = Path(__file__).resolve().parent.parent
pictures = [Image.open(checkout / "out" / f"bunny_{stage}.png").convert("RGB") for stage in ("cloud", "lines", "mesh")]
# Margins are cut alike so that the three stay in register.
box = (190, 0, 1010, 900)
width, height = box[2] - box[0], box[3] - box[1]
strip = Image.new("RGB", (width * len(pictures), height), "white")
for place, picture in enumerate(pictures):
    strip.paste(picture.crop(box), (place * width, 0))
strip.resize((strip.width // 2, strip.height // 2), Image.Resampling.LANCZOS).save(
    checkout / "docs" / "pipeline.png", optimize=True
)
