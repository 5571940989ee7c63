# MeshLab's window as its user sees it: menus, the dialog of a filter, the log, the layers, files.
# SPDX-License-Identifier: GPL-3.0-or-later
"""MeshLab, driven by mouse and keyboard."""

from __future__ import annotations

import re
import time
from collections.abc import Callable
from pathlib import Path

from desktop import Atspi, Desktop, Failure, Widget, accessible_programs, click, keys, wait_for, write, xdotool


class MeshLab:
    """A running MeshLab with the files given opened in it."""

    def __init__(self, desktop: Desktop, log: Path, *files: Path):
        self.desktop = desktop
        self.printed = log
        self.process = desktop.start("meshlab", *map(str, files), log=log)
        wait_for("the files to be opened", lambda: "All files opened" in log.read_text(errors="replace"), 60)
        wait_for("MeshLab to be accessible", accessible_programs, 60)
        self.application = wait_for("MeshLab", self._application)
        self.window = wait_for("its window", lambda: self._frame(r"MeshLab 20.*\[Project"))
        self.bar = self.window.find("progress bar").box

    def _application(self) -> Widget | None:
        return next((app for app in self.desktop.applications() if app.name.startswith("MeshLab")), None)

    def _frame(self, pattern: str) -> Widget | None:
        frames = [child for child in self.application.children() if re.match(pattern, child.name)]
        return next((frame for frame in frames if frame.on_screen), None)

    # --- what it shows -----------------------------------------------------------------------------------------------

    def log(self) -> str:
        panes = [widget for widget in self.window.everything() if widget.role == "text" and widget.on_screen]
        return next((pane.text for pane in panes if "opened in" in pane.text), "")

    def applied(self) -> int:
        """How many filters it has applied."""
        return self.printed.read_text(errors="replace").count("Applied filter")

    def alive(self) -> bool:
        return self.process.poll() is None

    def message(self) -> Widget | None:
        """The message box in front, if there is one."""
        return next((child for child in self.application.children() if child.role == "alert" and child.on_screen), None)

    def dismiss(self) -> str:
        """Reads the message box and closes it."""
        box = wait_for("a message", self.message)
        text = "\n".join(widget.text for widget in box.everything() if widget.role == "label")
        click(box.find("button", "OK").box.middle)
        wait_for("the message to go", lambda: not self.message())
        return text

    def progress(self) -> int:
        """How much of the progress bar is filled, in per cent."""
        x, y, width, height = self.bar
        row = self.desktop.pixels(x, y + height - 6, width, 1)
        return 100 * sum(blue > red + 40 for red, _, blue in row) // width

    def choose_layer(self, label: str) -> None:
        def cell() -> Widget | None:
            names = (label, label + " *")  # changed, not saved
            return next((w for n in names if (w := self.window.find("table cell", n))), None)

        click(wait_for(f"layer '{label}'", cell).box.middle)

    # --- menus -------------------------------------------------------------------------------------------------------

    def menu(self, *path: str) -> None:
        """Opens the menus one after another and chooses the last entry; by keyboard, as many entries move the mouse's way."""
        bar = self.window.find("menu bar", skip=())
        entry = next(child for child in bar.children() if child.name == path[0])
        click(entry.box.middle)
        for name in path[1:]:
            time.sleep(0.2)
            # The arrow keys pass over lines between entries, and over grey ones.
            items = [item for popup in entry.children() for item in popup.children()]
            entries = [item for item in items if item.role != "separator" and item.has(Atspi.StateType.ENABLED)]
            names = [item.name for item in entries]
            if name not in names:
                raise Failure(f"menu '{entry.name}' holds no '{name}'")
            # In the bar's menu nothing is chosen yet; a submenu opens with its first entry chosen.
            steps = names.index(name) + (entry.name == path[0])
            keys(*["Down"] * steps)
            entry = entries[names.index(name)]
            keys("Return" if name == path[-1] else "Right")

    # --- filters -----------------------------------------------------------------------------------------------------

    def filter(self, menu: str, name: str) -> Dialog:
        """Opens the filter's dialog from its menu."""
        self.menu("Filters", menu, name)
        return Dialog(self, name)

    def wait_for_filters(
        self,
        what: str,
        applied: int,
        seconds: float,
        watch: Callable[[int], None] = lambda _: None,
        picture: str | None = None,
    ) -> str | None:
        """Until the log tells of so many applied filters (None), or a message says why not (its text)."""

        def ended() -> str | None:
            # Only by what costs a busy window nothing: its printed log, its windows, its picture.
            watch(self.progress())
            if not self.alive():
                raise Failure(f"MeshLab died of '{what}'")
            if xdotool("search", "--all", "--name", "Filter Failure|MeshLab Filtering Error", check=False):
                return "message"
            return "applied" if self.applied() >= applied else None

        if wait_for(f"'{what}' to end", ended, seconds) != "message":
            return None
        if picture:
            self.desktop.screenshot(picture)
        return self.dismiss()

    # --- files -------------------------------------------------------------------------------------------------------

    def dialog(self, title: str) -> Widget:
        """The dialog whose title begins so."""
        dialog = wait_for(f"'{title}'", lambda: self._frame(title))
        time.sleep(0.5)  # until it has the keyboard
        return dialog

    def name_file(self, title: str, file: Path) -> None:
        """Types the file's name into the file dialog in front."""
        self.dialog(title)
        keys("ctrl+a")
        write(str(file))
        keys("Return")
        wait_for("the file dialog to close", lambda: not self._frame(title))

    def export(self, file: Path, *attributes: str) -> None:
        """Saves the current layer with what MeshLab suggests for this kind of file, and the custom attributes named."""
        self.menu("File", "Export Mesh As...")
        self.name_file("Save", file)
        form = self.dialog("Choose Saving Options")
        for attribute in attributes:
            click(beside(form, f"V(f): {attribute}").box.middle)
        click(form.find("button", "OK").box.middle)
        wait_for(f"{file.name} to be saved", lambda: file.exists() and not self._frame("Choose Saving Options"))

    def apply_script(self, file: Path, filters: int, seconds: float = 120.0) -> str | None:
        """Loads a filter script and runs it; the text of the message it ended with, if any."""
        before = self.applied()
        self.menu("Filters", "Show current filter script")
        form = self.dialog("Dialog$")  # MeshLab gives it no better title
        click(form.find("button", "Open Script").box.middle)
        self.name_file("Open Filter Script", file)
        self.desktop.screenshot("script")
        click(form.find("button", "Apply Script").box.middle)
        return self.wait_for_filters(file.name, before + filters, seconds)

    def load_plugin(self, file: Path) -> None:
        """Help, Plugin Info, Load Plugins."""
        self.menu("Help", "Plugin Info")
        form = self.dialog("Plugin Information")
        click(form.find("button", "Load Plugins").box.middle)
        self.name_file("Load Plugins", file)
        wait_for("the plugin in the list", lambda: [w for w in form.everything() if w.name == file.name])
        self.desktop.screenshot("plugin_info")
        click(form.find("button", "OK").box.middle)


def beside(form: Widget, label: str) -> Widget:
    """What stands to the right of the label."""
    shown = [widget for widget in form.everything() if widget.on_screen]
    row = next((widget.box for widget in shown if widget.role == "label" and widget.name == label), None)
    if row is None:
        raise Failure(f"'{form.name}' shows no '{label}'")
    for widget in shown:
        box = widget.box
        fillable = widget.role in ("text", "combo box", "check box", "spin button")
        if fillable and abs(box.middle[1] - row.middle[1]) < 8 and box.x >= row.x + row.width:
            return widget
    raise Failure(f"'{form.name}' has nothing to fill in beside '{label}'")


class Dialog:
    """The dialog of a filter."""

    def __init__(self, meshlab: MeshLab, name: str):
        self.meshlab = meshlab
        self.name = name
        self.frame = wait_for(f"the dialog of '{name}'", lambda: meshlab.application.find("frame", name))
        time.sleep(0.3)

    def field(self, label: str) -> Widget:
        return beside(self.frame, label)

    def set(self, label: str, value: object) -> None:
        field = self.field(label)
        if field.role == "check box":
            if field.has(Atspi.StateType.CHECKED) != value:
                click(field.box.middle)
        elif field.role == "combo box":
            click(field.box.middle)
            time.sleep(0.2)
            write(str(value))  # the list goes to the entry that begins so
            keys("Return")
        else:
            click(field.box.middle)
            keys("ctrl+a")
            write(str(value))
            keys("Tab")

    def screenshot(self, name: str) -> None:
        xdotool("mousemove", 5, 500)
        time.sleep(0.3)
        self.meshlab.desktop.screenshot(name, self.frame.box)

    def apply(
        self,
        seconds: float = 120.0,
        watch: Callable[[int], None] = lambda _: None,
        picture: str | None = None,
    ) -> str | None:
        """Runs the filter; the text of the message it ended with, if any, which ``picture`` is taken of."""
        before = self.meshlab.applied()
        click(self.frame.find("button", "Apply").box.middle)
        return self.meshlab.wait_for_filters(self.name, before + 1, seconds, watch, picture)

    def close(self) -> None:
        click(self.frame.find("button", "Close").box.middle)
        wait_for("the dialog to close", lambda: not self.meshlab.application.find("frame", self.name))
