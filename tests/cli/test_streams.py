"""What archgen does with its streams: colours, pipes that close early, streams that are closed or full."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from tests.cli.conftest import ROOT, Run
from tests.property_sizes import try_some


def _shell(script: str, project: Path, **environment: str) -> subprocess.CompletedProcess[str]:
    """Run a shell script in which `$archgen` is archgen and `$project` the project."""
    known = {
        **os.environ,
        "archgen": f"{sys.executable} -m archgen",
        "project": str(project),
        "PYTHONPATH": str(ROOT),
        "COLUMNS": "",
    }
    return subprocess.run(  # noqa: S603 - the scripts below
        ["bash", "-c", script],  # noqa: S607 - the shell of the machine
        env={**known, **environment},
        capture_output=True,
        text=True,
        timeout=600,
        check=False,
    )


def test_colours(broken: Path) -> None:
    assert "\x1b[" not in _shell("$archgen check $project", broken).stdout
    assert "\x1b[" in _shell("$archgen check $project", broken, FORCE_COLOR="1").stdout
    assert "\x1b[" not in _shell("$archgen check $project", broken, FORCE_COLOR="1", NO_COLOR="1").stdout


def test_a_reader_who_has_had_enough(broken: Path) -> None:
    ran = _shell("for i in 1 2 3; do $archgen explain | head -1; done", broken)
    assert (ran.stderr, len(ran.stdout.splitlines())) == ("", 3)
    ran = _shell("set -o pipefail; $archgen list -C $project | true; $archgen stats $project | true", broken)
    assert "Traceback" not in ran.stderr
    assert "mistake in archgen" not in ran.stderr


@pytest.mark.parametrize("verb", try_some(["check $project", "stats $project", "explain", "list -C $project"]))
def test_closed_streams(broken: Path, verb: str) -> None:
    ran = _shell(f"$archgen {verb} >&-; $archgen {verb} >&- 2>&-", broken)
    assert "mistake in archgen" not in ran.stderr
    assert "Error" not in ran.stderr


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no device that is always full")
@pytest.mark.parametrize("verb", try_some(["check -q $project", "explain", "explain unread-output"]))
def test_a_full_disk(broken: Path, verb: str) -> None:
    ran = _shell(f"$archgen {verb} > /dev/full", broken)
    assert (ran.returncode, ran.stderr) == (2, "archgen: failed: No space left on device\n")


def test_a_stream_that_is_not_utf_8(broken: Path) -> None:
    """Documents are UTF-8 all the same; text for people has question marks rather than no end."""
    file = broken / "archgen.yaml"
    file.write_text(file.read_text("utf-8").replace("Colour image", "Colour image ☃"), encoding="utf-8")
    script = "for f in text github json sarif junit; do $archgen check $project --format $f > $f; echo $?; done"
    ran = _shell(f"cd $project; {script}", broken, PYTHONIOENCODING="ascii", PYTHONUTF8="0")
    assert (ran.stdout.splitlines(), ran.stderr) == (["1"] * 5, "")
    assert "Colour image ?" in (broken / "text").read_text("ascii")
    assert "Colour image ☃" in (broken / "junit").read_text("utf-8")


INTERRUPTED = """
import signal
import sys

class Finder:
    def find_spec(self, name, *_):
        if name == MODULE:
            raise KeyboardInterrupt

sys.meta_path.insert(0, Finder())
from archgen.__main__ import main
main()
"""


@pytest.mark.parametrize("module", try_some(["archgen.pipeline", "click", "archgen.cli", "archgen.cli.check_command"]))
def test_an_interrupt_while_archgen_is_imported_shows_no_traceback(broken: Path, module: str, tmp_path: Path) -> None:
    (tmp_path / "interrupted.py").write_text(INTERRUPTED.replace("MODULE", repr(module)))
    ran = _shell(f"{sys.executable} {tmp_path / 'interrupted.py'} check $project", broken)
    assert (ran.returncode, ran.stdout, ran.stderr.lstrip()) == (130, "", "archgen: stopped\n")


@pytest.mark.parametrize(("number", "status"), [(signal.SIGTERM, 143), (signal.SIGHUP, 129)])
def test_what_would_end_it_at_once_stops_it_as_an_interrupt_does(
    broken: Path, number: signal.Signals, status: int, tmp_path: Path
) -> None:
    stopped = INTERRUPTED.replace("MODULE", repr("archgen.pipeline")).replace(
        "raise KeyboardInterrupt", f"import signal; signal.raise_signal({int(number)})"
    )
    (tmp_path / "stopped.py").write_text(stopped)
    ran = _shell(f"{sys.executable} {tmp_path / 'stopped.py'} check $project", broken)
    assert (ran.returncode, ran.stdout, ran.stderr.lstrip()) == (status, "", "archgen: stopped\n")
    # What a caller ignores, as `nohup` does, stays ignored.
    ran = _shell(
        f"trap '' {number.name.removeprefix('SIG')}; {sys.executable} {tmp_path / 'stopped.py'} check $project", broken
    )
    assert ran.returncode == 1


def test_hardly_anything_is_imported_before_an_interrupt_is_caught(broken: Path) -> None:
    program = (
        "import sys; before = set(sys.modules); import archgen.__main__; print(*sorted(set(sys.modules) - before))"
    )
    ran = _shell(f"cd {ROOT} && {sys.executable} -c '{program}'", broken)
    assert set(ran.stdout.split()) <= {"__future__", "archgen", "archgen.__main__", "gc"}


@pytest.mark.parametrize("columns", ["40", "60", "200"])
@pytest.mark.parametrize(
    "verb",
    [
        "timing $example", "timing $example --chain fall_to_call", "list -C $example",
        "list --of connections -C $example", "list --of hosts -C $example", "explain", "owners $example",
        "stats $example", "show object_recognition -C $example", "check $project",
    ],
)  # fmt: skip
def test_nothing_is_wider_than_columns_says(
    run: Run, monkeypatch: pytest.MonkeyPatch, broken: Path, verb: str, columns: str
) -> None:
    _demand_width(run, monkeypatch, broken, verb, columns)


@pytest.mark.slow
def test_what_an_improvement_needs_is_not_wider_than_columns_says(
    run: Run, monkeypatch: pytest.MonkeyPatch, broken: Path
) -> None:
    """It is computed for seconds, so the narrowest is tried alone here: test_timing_legend tries two other widths."""
    _demand_width(run, monkeypatch, broken, "timing $example --sensitivity fall_to_call", "40")


def _demand_width(run: Run, monkeypatch: pytest.MonkeyPatch, broken: Path, verb: str, columns: str) -> None:
    monkeypatch.setenv("COLUMNS", columns)
    places = {"$example": ROOT / "example_ramcip", "$project": broken}
    lines = run(*(places.get(word, word) for word in verb.split())).out.splitlines()
    assert len(lines) > 5
    assert max(map(len, lines)) <= int(columns)


@pytest.mark.parametrize("verb", try_some(["check $project", "explain"]))
def test_a_pipe_gets_every_row_on_one_line(broken: Path, verb: str) -> None:
    _demand_whole_rows(*(_shell(f"$archgen {verb}", broken, COLUMNS=width).stdout for width in ("50", "", "1000")))


@pytest.mark.parametrize("words", [("timing",), ("list", "--of", "connections", "-C")], ids=" ".join)
def test_rows_of_the_case_study_that_no_terminal_shows_are_whole(
    run: Run, monkeypatch: pytest.MonkeyPatch, words: tuple[str, ...]
) -> None:
    printed = []
    for width in ("50", "", "1000"):
        monkeypatch.setenv("COLUMNS", width)
        printed.append(run(*words, ROOT / "example_ramcip").out)
    _demand_whole_rows(*printed)


def _demand_whole_rows(narrow: str, full: str, wide: str) -> None:
    assert len(narrow.splitlines()) > len(full.splitlines())
    assert max(map(len, full.splitlines())) > 70
    assert full == wide
