"""What the verbs share: checking before writing, selectors, errors in one line, what is printed."""

from __future__ import annotations

import errno
import io
from pathlib import Path

import click
import pytest

from archgen.cli import command_support
from archgen.diagnostics.diagnostic import Diagnostic, Severity
from archgen.diagnostics.source_span import NO_SPAN
from archgen.emit.file_tree import OutputError


def _finding(severity: Severity) -> Diagnostic:
    return Diagnostic("unread-output", "x", NO_SPAN, severity)


@pytest.mark.parametrize(
    ("severities", "strict", "status"),
    [
        ([], True, 0),
        ([Severity.NOTE], True, 0),
        ([Severity.WARNING], False, 0),
        ([Severity.WARNING], True, 1),
        ([Severity.NOTE, Severity.ERROR], False, 1),
    ],
)
def test_errors_fail_and_warnings_only_where_it_is_strict(
    severities: list[Severity],
    strict: bool,  # noqa: FBT001
    status: int,
) -> None:
    assert command_support.exit_status([_finding(each) for each in severities], strict=strict) == status


def test_nothing_is_written_from_a_project_with_errors(broken: Path, capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as stopped:
        command_support.check_before_writing(broken, keep_going=False)
    printed = capsys.readouterr().err
    assert stopped.value.code == 1
    assert "unknown-reference" in printed
    assert printed.endswith("Nothing was written. With --keep-going outputs are made of what is sound.\n")
    assert command_support.check_before_writing(broken, keep_going=True).has_errors


def test_without_a_project_it_is_wrong_usage(tmp_path: Path) -> None:
    with pytest.raises(click.UsageError, match=r"holds no archgen\.yaml"):
        command_support.check_or_exit(tmp_path)


def test_a_selector_that_names_nothing_is_wrong_usage(first: Path, capsys: pytest.CaptureFixture[str]) -> None:
    checked = command_support.check_or_exit(first)
    assert command_support.select_or_exit(checked, None) is None
    with pytest.raises(click.UsageError, match="nothing is called `x␛y`; `archgen list` gives"):
        command_support.select_or_exit(checked, "x\x1by")
    assert "\x1b" not in capsys.readouterr().err


@pytest.mark.parametrize(
    ("error", "said"),
    [
        (OutputError("no place", "make some"), "no place; make some"),
        (OutputError("no place"), "no place"),
        (OutputError("\x1b[2J"), "␛[2J"),
        (OSError(errno.ENOSPC, "No space left", "out/a"), "No space left: out/a"),
        (OSError("odd"), "odd"),
    ],
)
def test_what_goes_wrong_while_writing_is_one_line(error: Exception, said: str) -> None:
    with pytest.raises(click.ClickException) as shown, command_support.explain_write_errors():
        raise error
    assert shown.value.message == said


def test_a_file_is_read_up_to_one_byte_more_than_allowed(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (tmp_path / "a").write_bytes(b"12345")
    assert command_support.read_input(tmp_path / "a", 3) == b"1234"
    monkeypatch.setattr("sys.stdin", io.TextIOWrapper(io.BytesIO(b"12345")))
    assert command_support.read_input(Path("-"), 3) == b"1234"
    with pytest.raises(click.ClickException, match=r"cannot read .*gone: No such file or directory"):
        command_support.read_input(tmp_path / "gone", 3)


def test_paths_below_the_current_folder_are_short(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    command_support.print_written(tmp_path / "out" / "a.docx", "3 pages")
    command_support.print_written(Path("/elsewhere/a.docx"))
    assert capsys.readouterr().out == "wrote out/a.docx (3 pages)\nwrote /elsewhere/a.docx\n"


def test_progress_is_shown_on_terminals_only(monkeypatch: pytest.MonkeyPatch) -> None:
    assert command_support.make_progress_printer() is None
    screen = io.StringIO()
    monkeypatch.setattr(screen, "isatty", lambda: True)
    monkeypatch.setattr("sys.stderr", screen)
    show = command_support.make_progress_printer("drawing")
    assert show is not None
    for done in (1, 2, 3):
        show(done, 3)
    assert screen.getvalue().startswith("\r\x1b[Kdrawing: 1 of 3")
    assert screen.getvalue().endswith("\r\x1b[Kdrawing: 3 of 3\r\x1b[K")


def test_long_work_says_how_long_it_goes_on() -> None:
    assert [command_support.describe_time_left(*each) for each in ((2.9, 1, 9), (9, 0, 9), (9, 9, 9))] == [""] * 3
    assert command_support.describe_time_left(10, 4, 10) == ", some 15 s left"
    assert command_support.describe_time_left(60, 10, 100) == ", some 9 min left"
