"""The same input gives the same bytes, wherever and under whatever settings; the packed file stands for the folder."""

from __future__ import annotations

import json
import os
import re
import shutil
from pathlib import Path

import pytest

from tests import readable
from tests.running import RAMCIP, REVISION, archgen, archgen_here, contents

ELSEWHERE = {
    "TZ": "Asia/Kathmandu",
    "LC_ALL": "C",
    "LANG": "tr_TR.UTF-8",
    "PYTHONCOERCECLOCALE": "0",
    "PYTHONHASHSEED": "4711",
    "PYTHONUTF8": "0",
    "COLUMNS": "53",
    "NO_COLOR": "1",
}
EVERYTHING = ("--backend", "wiki", "--revision", REVISION, "--no-history")


@pytest.fixture(scope="module")
def moved(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Copy the case study into another folder."""
    project = tmp_path_factory.mktemp("a folder, elsewhere") / "çöpy"
    shutil.copytree(RAMCIP, project, ignore=shutil.ignore_patterns("archgen-out"))
    return project


@pytest.fixture(scope="module")
def unpacked(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Pack the case study, and return a folder that holds the packed file alone."""
    place = tmp_path_factory.mktemp("packed")
    archgen_here("pack", RAMCIP, "-o", place / "ramcip.yaml", cwd=RAMCIP.parent)
    return place


@pytest.fixture(scope="module")
def built(unpacked: Path) -> Path:
    """Build everything from the packed file alone."""
    archgen("build", "ramcip.yaml", *EVERYTHING, "-o", "out", cwd=unpacked)
    return unpacked / "out"


@pytest.mark.slow
def test_two_builds_are_the_same_bytes(ramcip: Path, moved: Path) -> None:
    """In another folder and working folder, with another time zone, locale, hash seed and umask."""
    environment = {**ELSEWHERE, "XDG_CACHE_HOME": str(moved.parent / "cache")}
    old = os.umask(0o077)
    try:
        archgen("build", *EVERYTHING, "-o", "../out", cwd=moved / "groups", env=environment)
    finally:
        os.umask(old)
    first, second = contents(ramcip), contents(moved / "out")
    assert sorted(first) == sorted(second)
    assert [path for path, data in first.items() if second[path] != data] == []


def test_pictures_in_every_format_are_the_same_bytes(moved: Path, tmp_path: Path) -> None:
    wanted = ("--format", "svg,png,pdf,dot", "--only", "overview", "--only", "groups/human_*", "--only", "hosts")
    archgen("diagram", RAMCIP, *wanted, "-o", "a", cwd=tmp_path, env={"XDG_CACHE_HOME": str(tmp_path / "1")})
    settings = {**ELSEWHERE, "XDG_CACHE_HOME": str(tmp_path / "2")}
    archgen("diagram", moved, *wanted, "-o", tmp_path / "b", cwd=moved, env=settings)
    first, second = contents(tmp_path / "a"), contents(tmp_path / "b")
    assert len(first) == 4 * 4 + 1
    assert [path for path, data in first.items() if second[path] != data] == []


@pytest.mark.parametrize(
    "words",
    [
        ("check", "--format", "json"),
        ("list", "--of", "edges", "--format", "csv"),
        *(
            pytest.param(words, marks=pytest.mark.slow)
            for words in (
                ("check", "--format", "text"),
                ("stats",),
                ("stats", "--format", "json"),
                ("show", "object_recognition"),
            )
        ),
    ],
    ids=" ".join,
)
def test_what_is_printed_is_the_same_bytes(words: tuple[str, ...], moved: Path) -> None:
    project = (lambda path: ("-C", path)) if words[0] in {"list", "show"} else lambda path: (path,)
    # Here and in a process of its own.
    first = archgen_here(*words, *project(RAMCIP), cwd=RAMCIP.parent).stdout
    second = archgen(
        *words, *project(moved), cwd=moved, env={**ELSEWHERE, "COLUMNS": "", "PYTHONIOENCODING": "utf-8"}
    ).stdout
    assert first.decode() == second.decode()


def test_packing_again_gives_the_same_bytes(unpacked: Path) -> None:
    archgen_here("pack", "ramcip.yaml", "-o", "again.yaml", cwd=unpacked)
    assert (unpacked / "again.yaml").read_bytes() == (unpacked / "ramcip.yaml").read_bytes()


def test_the_packed_file_has_the_same_size_and_progress(unpacked: Path) -> None:
    folder, packed = (
        json.loads(archgen_here("stats", project, "--format", "json", cwd=unpacked).stdout)
        for project in (RAMCIP, "ramcip.yaml")
    )
    assert (folder.pop("files"), packed.pop("files")) == (19, 1)
    assert folder == packed


def test_the_packed_file_has_the_same_findings(unpacked: Path) -> None:
    folder, packed = (
        [
            (found["rule"], found["severity"], found["element"], found["message"])
            for found in json.loads(archgen_here("check", project, "--format", "json", cwd=unpacked).stdout)[
                "diagnostics"
            ]
        ]
        for project in (RAMCIP, "ramcip.yaml")
    )
    assert sorted(folder) == sorted(packed)


@pytest.mark.slow
def test_building_packs_the_same_bytes(ramcip: Path, built: Path) -> None:
    packed = (ramcip / "packed.yaml").read_bytes()
    assert packed == (built / "packed.yaml").read_bytes()
    assert packed == (built.parent / "ramcip.yaml").read_bytes()


@pytest.mark.slow
@pytest.mark.parametrize("place", ["diagrams", "site", "wiki"])
def test_the_packed_file_makes_the_same_files(place: str, ramcip: Path, built: Path) -> None:
    first, second = contents(ramcip / place), contents(built / place)
    assert sorted(first) == sorted(second)
    changed = [path for path, data in first.items() if placeless(second[path]) != placeless(data)]
    assert set(changed) <= {".archgen-files"}


@pytest.mark.slow
def test_the_packed_file_makes_the_same_report(ramcip: Path, built: Path) -> None:
    first, second = (readable.document(folder / "report.docx").encode() for folder in (ramcip, built))
    # A figure changes places with the table behind it where a page has no more room, and that is so for longer names of files.
    assert sorted(placeless(first).splitlines()) == sorted(placeless(second).splitlines())


def test_the_packed_file_makes_the_same_record(unpacked: Path) -> None:
    records = []
    for project in (RAMCIP, "ramcip.yaml"):
        archgen_here("pack", "--resolved", project, "-o", "resolved.yaml", cwd=unpacked)
        records.append((unpacked / "resolved.yaml").read_bytes())
    assert placeless(records[0]).splitlines() == placeless(records[1]).splitlines()


def placeless(data: bytes) -> bytes:
    """Take the places in files out of an output: in the packed file everything stands elsewhere."""
    data = data.replace(b"<wbr>", b"").replace("\u200b".encode(), b"")
    return re.sub(rb"[a-z_/]+\.yaml:\d+(:\d+)?", b"PLACE", data)
