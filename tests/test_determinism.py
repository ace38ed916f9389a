"""The same input gives the same bytes, wherever and under whatever settings; the packed file stands for the folder."""

from __future__ import annotations

import json
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from tests import readable
from tests.determined_project import make_every_output_once, make_project, run_every_output
from tests.judged_projects import SAID_BY_PACKING
from tests.property_sizes import try_some
from tests.running import RAMCIP, REVISION, ROOT, archgen, archgen_here, contents

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


@pytest.mark.slow
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
        *(
            pytest.param(words, marks=pytest.mark.slow)
            for words in (
                ("list", "--of", "edges", "--format", "csv"),
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


@pytest.mark.slow
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
            if found["rule"] not in SAID_BY_PACKING
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


LOCALES = (
    *(("tr_TR", "UTF-8"), ("de_DE", "UTF-8"), ("ja_JP", "UTF-8"), ("tr_TR", "ISO-8859-9"), ("ja_JP", "EUC-JP")),
    *(("C", "UTF-8"), ("C", ""), ("POSIX", "")),
)
ZONES = ("UTC", "Asia/Kathmandu", "America/St_Johns", "Pacific/Kiritimati", "Europe/Berlin", ":/nonexistent")
FOLDERS = (
    "plain",
    "with blanks  in it",
    "çöpy ü",
    "日本語/ロボット",
    "a" * 100,
    "it's $HOME; `x` & %d #1",
    "-o",
    ".hidden",
)
_SHOWN_SETTINGS = 2
"""So many settings have each locale, time zone, folder, mask and number of processors."""


@pytest.fixture(scope="module")
def locales(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Compile the locales that this system has the sources of; programs take any other one for C."""
    folder = tmp_path_factory.mktemp("locales")
    for language, charset in LOCALES:
        if charset and language != "C":
            words = ("localedef", "-i", language, "-f", charset, folder / f"{language}.{charset}")
            subprocess.run(words, capture_output=True, check=False)  # noqa: S603 - of Debian's base system
    return folder


@pytest.fixture(scope="module")
def every_output(tmp_path_factory: pytest.TempPathFactory, worker_id: str) -> dict[str, bytes]:
    """Make every output under the settings of the tests."""
    return make_every_output_once(tmp_path_factory, worker_id)


@pytest.mark.parametrize("number", try_some(range(20), 0, _SHOWN_SETTINGS))
def test_twenty_settings_make_the_same_bytes_of_every_output(
    number: int, every_output: dict[str, bytes], tmp_path: Path, locales: Path
) -> None:
    """Hash seeds, locales, time zones, folders, numbers of processors, masks of permissions, cold and warm caches."""
    language, charset = LOCALES[number % len(LOCALES)]
    project = make_project(tmp_path / FOLDERS[(number * 3) % len(FOLDERS)])
    environment = {
        "PYTHONPATH": str(ROOT),
        "PYTHONHASHSEED": str(number * 101),
        "LC_ALL": ".".join(filter(None, (language, charset))),
        "LOCPATH": str(locales),
        "TZ": ZONES[number % len(ZONES)],
        "PYTHONUTF8": str(number // 3 % 2),
        "PYTHONCOERCECLOCALE": "0",
        # Each third has a cache of its own, which is empty.
        **({} if number % 3 else {"XDG_CACHE_HOME": str(tmp_path / "cache")}),
    }
    old = os.umask((0o022, 0o077, 0o002)[number % 3])
    try:
        made = run_every_output(sys.executable, project, tmp_path / "out", environment, 1 + number % 5)
    finally:
        os.umask(old)
    assert sorted(made) == sorted(every_output)
    assert [name for name, data in every_output.items() if made[name] != data] == []
    statuses = made["statuses.txt"].decode()
    assert statuses.count("\n0 ") > 55, statuses
