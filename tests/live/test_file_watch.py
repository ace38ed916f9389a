"""What counts as a change of a project's files."""

from __future__ import annotations

import os
import threading
from pathlib import Path

import pytest

from archgen.live.file_watch import WatchedPlaces, join_paths, take_snapshot, watch_files


def write(file: Path, text: str = "x") -> None:
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(text)


CHANGES = {
    "another content": lambda root: write(root / "a.yaml", "xy"),
    "another time": lambda root: os.utime(root / "a.yaml", ns=(1, 1)),
    "a new file in a new folder": lambda root: write(root / "new" / "deep" / "b.yml"),
    "a file is gone": lambda root: (root / "a.yaml").unlink(),
    "another file of the same name": lambda root: (root / "c.yaml").replace(root / "a.yaml"),
    "a message": lambda root: write(root / "msg" / "A.msg"),
    "a picture of a chapter": lambda root: write(root / "docs" / "p.PNG"),
    "a file that is named": lambda root: write(root / "chapter.txt", "xy"),
    "a file outside that is named": lambda root: write(root.parent / "outside.txt", "xy"),
}
NO_CHANGES = {
    "nothing": lambda _root: None,
    "its own output": lambda root: write(root / "archgen-out" / "b.yaml"),
    "a hidden folder": lambda root: write(root / ".git" / "b.yaml"),
    "an editor's own file": lambda root: write(root / ".a.yaml.swp"),
    "no file of a project": lambda root: write(root / "robot.bag"),
}


@pytest.fixture
def places(tmp_path: Path) -> WatchedPlaces:
    root = tmp_path / "robot"
    for name in ("a.yaml", "c.yaml", "chapter.txt", "../outside.txt"):
        write(root / name)
    return WatchedPlaces((root,), join_paths(root, ("chapter.txt", "../outside.txt", "missing.yaml")))


@pytest.mark.parametrize("name", [*CHANGES, *NO_CHANGES])
def test_a_look_sees_changes_of_the_project(name: str, places: WatchedPlaces) -> None:
    before = take_snapshot(places)
    (CHANGES | NO_CHANGES)[name](places.folders[0])
    assert (take_snapshot(places) != before) == (name in CHANGES)


def test_a_folder_that_links_to_itself_or_cannot_be_read_is_no_trouble(places: WatchedPlaces) -> None:
    (places.folders[0] / "loop").symlink_to(places.folders[0])
    (places.folders[0] / "broken.yaml").symlink_to("nowhere")
    assert len(take_snapshot(places)) == 4
    assert take_snapshot(WatchedPlaces((places.folders[0] / "missing",))) == {}


def test_one_change_is_told_once_and_only_when_it_is_saved(places: WatchedPlaces) -> None:
    told: list[int] = []
    stopped, seen, looked_twice = threading.Event(), threading.Event(), threading.Event()
    looks: list[WatchedPlaces] = []

    def choose_places() -> WatchedPlaces:
        looks.append(places)
        if len(looks) == 3:  # what two looks saw is known by now
            looked_twice.set()
        return places

    def see() -> None:
        told.append((places.folders[0] / "a.yaml").stat().st_size)
        seen.set()

    watching = threading.Thread(target=watch_files, args=(choose_places, see, stopped))
    watching.start()
    try:
        assert looked_twice.wait(120)
        assert not seen.wait(0.3)
        write(places.folders[0] / "a.yaml", "longer")
        assert seen.wait(120)
        stopped.wait(0.3)
        assert told == [6]
    finally:
        stopped.set()
        watching.join(120)
    assert not watching.is_alive()
