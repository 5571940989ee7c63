# A screen without a monitor, and a person in front of it: looks through the accessibility tree, acts through xdotool.
# Runs inside the root that make_root.sh made.
# SPDX-License-Identifier: GPL-3.0-or-later
"""What is on the screen and where, and the mouse and keyboard to act on it."""

from __future__ import annotations

import os
import subprocess
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import NamedTuple

import gi

gi.require_version("Atspi", "2.0")
from gi.repository import Atspi, GLib  # noqa: E402

DISPLAY = ":77"
SIZE = (1400, 1000)


class Failure(Exception):
    """What a person would complain about."""


class Box(NamedTuple):
    x: int
    y: int
    width: int
    height: int

    @property
    def middle(self) -> tuple[int, int]:
        return self.x + self.width // 2, self.y + self.height // 2


class Widget:
    """One node of the accessibility tree."""

    def __init__(self, node: Atspi.Accessible):
        self.node = node

    @property
    def role(self) -> str:
        return self.node.get_role_name()

    @property
    def name(self) -> str:
        return self.node.get_name() or ""

    @property
    def box(self) -> Box:
        extents = self.node.get_extents(Atspi.CoordType.SCREEN)
        return Box(extents.x, extents.y, extents.width, extents.height)

    @property
    def text(self) -> str:
        text = self.node.get_text_iface()
        return Atspi.Text.get_text(text, 0, Atspi.Text.get_character_count(text)) if text else self.name

    @property
    def value(self) -> float:
        return self.node.get_value_iface().get_current_value()

    def has(self, state: Atspi.StateType) -> bool:
        return self.node.get_state_set().contains(state)

    @property
    def on_screen(self) -> bool:
        return self.has(Atspi.StateType.SHOWING) and self.box.width > 0

    def children(self) -> Iterator[Widget]:
        for index in range(self.node.get_child_count()):
            if (child := self.node.get_child_at_index(index)) is not None:
                yield Widget(child)

    def everything(self, skip: tuple[str, ...] = ("menu bar",)) -> Iterator[Widget]:
        """This and all below it, without the hundreds of items of closed menus."""
        yield self
        for child in self.children():
            try:
                if child.role not in skip:
                    yield from child.everything(skip)
            except GLib.Error:
                continue  # gone while we looked

    def find(self, role: str, name: str | None = None, skip: tuple[str, ...] = ("menu bar",)) -> Widget | None:
        for widget in self.everything(skip):
            try:
                if widget.role == role and (name is None or widget.name == name) and widget.on_screen:
                    return widget
            except GLib.Error:
                continue
        return None


def accessible_programs() -> int:
    """How many there are; asked by another process, for the library remembers what it sees before it is ready."""
    code = "import gi; gi.require_version('Atspi', '2.0'); from gi.repository import Atspi; "
    code += "print(Atspi.get_desktop(0).get_child_count())"
    return int(subprocess.run(["python3", "-c", code], check=True, capture_output=True, text=True).stdout)


def xdotool(*arguments: object, check: bool = True) -> str:
    command = ["xdotool", *map(str, arguments)]
    return subprocess.run(command, check=check, capture_output=True, text=True).stdout


def click(place: tuple[int, int]) -> None:
    xdotool("mousemove", *place, "click", 1)


def keys(*names: str) -> None:
    for name in names:
        xdotool("key", "--clearmodifiers", name)


def write(text: str) -> None:
    xdotool("type", "--delay", 5, "--", text)


def wait_for(what: str, look: Callable[[], object], seconds: float = 20.0):
    """The first thing ``look`` finds."""
    end = time.monotonic() + seconds
    while True:
        while GLib.MainContext.default().iteration(False):
            pass  # the library learns of changes by messages
        try:
            if found := look():
                return found
        except (GLib.Error, subprocess.CalledProcessError):
            pass  # not there yet, busy, or just gone
        if time.monotonic() > end:
            raise Failure(f"waited {seconds:.0f} s for {what}")
        time.sleep(0.1)


class Desktop:
    """An X server without a screen, a window manager, and the accessibility bus; as a context."""

    def __init__(self, pictures: Path):
        self.pictures = pictures
        self.processes: list[subprocess.Popen] = []

    def __enter__(self) -> Desktop:
        Path("/tmp/.X11-unix").mkdir(mode=0o1777, exist_ok=True)
        self.start("Xvfb", DISPLAY, "-screen", "0", f"{SIZE[0]}x{SIZE[1]}x24", "-nolisten", "tcp")
        os.environ["DISPLAY"] = DISPLAY
        wait_for("the X server", lambda: xdotool("getdisplaygeometry"))
        self.start("openbox")
        # Told of the screen, the accessibility bus writes its address there, where Qt finds it before the first window.
        # By messages alone Qt gets it later, after the only time it tries to use it.
        subprocess.run(["dbus-update-activation-environment", "DISPLAY"], check=True)
        ask = "dbus-send --session --print-reply --dest=org.a11y.Bus /org/a11y/bus org.a11y.Bus.GetAddress"
        subprocess.run(ask.split(), check=True, stdout=subprocess.DEVNULL)
        self.start("/usr/libexec/at-spi2-registryd")
        time.sleep(1)
        return self

    def __exit__(self, *_: object) -> None:
        for process in reversed(self.processes):
            process.terminate()
            process.wait()

    def start(self, *command: str, log: Path | None = None) -> subprocess.Popen:
        output = open(log, "w") if log else subprocess.DEVNULL
        process = subprocess.Popen(command, stdout=output, stderr=subprocess.STDOUT)
        self.processes.append(process)
        return process

    def stop(self, process: subprocess.Popen) -> None:
        self.processes.remove(process)
        process.kill()
        process.wait()

    def screenshot(self, name: str, box: Box | None = None) -> None:
        crop = ["-crop", f"{box.width}x{box.height}+{box.x}+{box.y}", "+repage"] if box else []
        file = self.pictures / f"{name}.png"
        subprocess.run(["import", "-silent", "-window", "root", *crop, "-colors", "256", str(file)], check=True)

    def pixels(self, x: int, y: int, width: int, height: int) -> list[tuple[int, int, int]]:
        """Red, green and blue, row by row."""
        crop = ["-crop", f"{width}x{height}+{x}+{y}", "-depth", "8", "rgb:-"]
        data = subprocess.run(["import", "-silent", "-window", "root", *crop], check=True, capture_output=True).stdout
        return list(zip(data[::3], data[1::3], data[2::3]))

    def applications(self) -> list[Widget]:
        desktop = Atspi.get_desktop(0)
        desktop.clear_cache()
        return list(Widget(desktop).children())
