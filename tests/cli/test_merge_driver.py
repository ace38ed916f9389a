"""`archgen merge-driver` as git calls it: what it writes, what it says, and a whole `git merge` with it."""

from __future__ import annotations

import os
import sys
import threading
from pathlib import Path

import pytest

from tests import repositories
from tests.cli.conftest import Ran, Run
from tests.running import ROOT

BASE = "nodes:\n  n: {rate: 10 Hz, wcet: 5 ms}\n"


def write_versions(folder: Path, *texts: str | bytes) -> list[Path]:
    files = [folder / name for name in ("base", "ours", "theirs")]
    for file, text in zip(files, texts, strict=True):
        file.write_bytes(text if isinstance(text, bytes) else text.encode())
    return files


def test_what_both_sides_say_is_written_over_ours(run: Run, tmp_path: Path) -> None:
    files = write_versions(tmp_path, BASE, BASE.replace("10", "20"), BASE.replace("5", "6"))
    assert run("merge-driver", *files, "a.yaml") == Ran(0, "", "")
    assert files[1].read_text() == "nodes:\n  n: {rate: 20 Hz, wcet: 6 ms}\n"
    assert files[2].read_text() == BASE.replace("5", "6")


def test_markers_stand_where_both_sides_changed_one_thing(run: Run, tmp_path: Path) -> None:
    files = write_versions(tmp_path, BASE, BASE.replace("10", "20"), BASE.replace("10", "30"))
    ran = run("merge-driver", "--marker-size", "9", *files, "groups/a.yaml")
    assert (ran.status, ran.out, ran.err) == (1, "", "archgen: groups/a.yaml: both sides changed `nodes.n.rate`\n")
    assert files[1].read_text() == (
        "nodes:\n<<<<<<<<< ours\n  n: {rate: 20 Hz, wcet: 5 ms}\n=========\n"
        "  n: {rate: 30 Hz, wcet: 5 ms}\n>>>>>>>>> theirs\n"
    )


def test_one_id_that_lines_merge_into_twice_is_no_clean_merge(run: Run, tmp_path: Path) -> None:
    base = "hosts:\n  a: 1\n  b: 2\n  c: 3\n  d: 4\n"
    files = write_versions(tmp_path, base, base.replace("  a", "  x: {cores: 1}\n  a"), base + "  x: {cores: 2}\n")
    ran = run("merge-driver", *files, "hosts.yaml")
    assert ran.status == 1
    assert ran.err == "archgen: hosts.yaml: both sides changed `hosts.x.cores`, and git takes the lines of both\n"


def test_what_is_no_text_is_left_to_people(run: Run, tmp_path: Path) -> None:
    files = write_versions(tmp_path, b"\x00", b"\x00\x01", b"\x00\x02")
    ran = run("merge-driver", *files, "a\x1b.yaml")
    assert ran.status == 2
    assert "cannot merge" in ran.err
    assert "\x1b" not in ran.err
    assert files[1].read_bytes() == b"\x00\x01"


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="no named pipes")
def test_what_never_ends_is_not_waited_for(run: Run, tmp_path: Path) -> None:
    files = write_versions(tmp_path, BASE, BASE, BASE)
    files[0].unlink()
    os.mkfifo(files[0])
    what_ends_it = threading.Timer(5, lambda: os.close(os.open(files[0], os.O_WRONLY | os.O_NONBLOCK)))
    what_ends_it.start()
    ran = run("merge-driver", *files, "a.yaml")
    what_ends_it.cancel()
    assert (ran.status, "a.yaml" in ran.err, "this is a named pipe, not a file" in ran.err) == (2, True, True)


def test_git_merges_with_it(tmp_path: Path) -> None:
    folder = repositories.repository(
        tmp_path / "robot", {"a.yaml": BASE, ".gitattributes": "*.yaml merge=archgen\n", "b.yaml": "x: 1\n"}
    )
    driver = f"PYTHONPATH={ROOT} {sys.executable} -m archgen merge-driver --marker-size=%L %O %A %B %P"
    repositories.git(folder, "config", "merge.archgen.driver", driver)
    repositories.git(folder, "checkout", "-q", "-b", "other")
    repositories.commit(folder, {"a.yaml": BASE.replace("5", "6"), "b.yaml": "x: 2\n"})
    repositories.git(folder, "checkout", "-q", "main")
    repositories.commit(folder, {"a.yaml": BASE.replace("10", "20"), "b.yaml": "x: 1\ny: 1\n"})
    repositories.git(folder, "merge", "-q", "--no-edit", "other")
    assert (folder / "a.yaml").read_text() == "nodes:\n  n: {rate: 20 Hz, wcet: 6 ms}\n"
    assert (folder / "b.yaml").read_text() == "x: 2\ny: 1\n"
