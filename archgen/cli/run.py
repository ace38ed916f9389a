"""What commands have in common: check a project, print findings and written files, show progress, end with a status."""

from __future__ import annotations

import os
import shutil
import sys
import time
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, NoReturn, TextIO

import click

from archgen.diagnostic import Diagnostic, Severity

if TYPE_CHECKING:
    from archgen.model.selector import Selection
    from archgen.pipeline import Checked
    from archgen.source import Sources

ERROR = Severity.ERROR


def check(project: Path | None) -> Checked:
    """Check a project. It is wrong usage if there is none."""
    from archgen import pipeline
    from archgen.project import ProjectNotFoundError

    try:
        return pipeline.check(project)
    except ProjectNotFoundError as error:
        raise click.UsageError(str(error)) from None


def trusted(project: Path | None, revision: str | None) -> tuple[str, ...] | None:
    """Return the project's own backends that a revision allows to run in a review; None if no revision is given: all
    may.
    """
    from archgen import git, pipeline
    from archgen.project import NotAtRevisionError

    if not revision:
        return None
    try:
        # The main line decides: the branch under review must not allow its own templates to run.
        return pipeline.check_at(project, revision).architecture.review.backends
    # A project that is new in this branch: nothing is allowed yet.
    except NotAtRevisionError:
        return ()
    except git.GitError as error:
        raise click.UsageError(str(error)) from None


def report(checked: Checked, *, least: Severity = Severity.WARNING) -> None:
    """Print findings from a severity on, and their count, to the error stream."""
    order = [Severity.NOTE, Severity.WARNING, Severity.ERROR]
    # A finding without a severity counts as severe enough: it must not vanish.
    shown = [d for d in checked.findings if order.index(d.severity or least) >= order.index(least)]
    if shown:
        lines(shown, checked, sys.stderr)


def lines(shown: Sequence[Diagnostic], checked: Checked, stream: TextIO) -> None:
    """Print a project's findings for people, as wide as the terminal."""
    excerpts(shown, checked.sources, stream)


def excerpts(shown: Sequence[Diagnostic], sources: Sources, stream: TextIO) -> None:
    """Print findings with the lines of these sources."""
    from archgen.findings import text

    colour = text.wants_colour(stream, os.environ)
    width = shutil.get_terminal_size().columns if stream.isatty() else text.WIDTH
    stream.writelines(f"{line}\n" for line in text.render(shown, sources, colour=colour, width=width))


def status(findings: Sequence[Diagnostic], *, strict: bool = False) -> int:
    """Return the exit status for findings: 1 with errors (`strict`: or warnings), else 0."""
    bad = {Severity.ERROR, Severity.WARNING} if strict else {Severity.ERROR}
    return 1 if any(finding.severity in bad for finding in findings) else 0


def ready(project: Path | None, *, keep_going: bool) -> Checked:
    """Check a project before something is written. Errors are printed and, without --keep-going, end the run."""
    checked = check(project)
    report(checked, least=Severity.ERROR)
    if status(checked.findings) and not keep_going:
        click.echo("Nothing was written. With --keep-going outputs are made of what is sound.", err=True)
        sys.exit(1)
    return checked


def selected(checked: Checked, words: str | None) -> Selection | None:
    """Evaluate a selector from the command line. What names nothing is wrong usage."""
    from archgen import outputs
    from archgen.findings.escape import visible

    if words is None:
        return None
    selection, problems = outputs.select(checked, words)
    for problem in problems:
        click.echo(visible(f"{problem.severity}: {problem.message}"), err=True)
        if problem.help:
            click.echo(visible(f"  = help: {problem.help}"), err=True)
    if any(problem.severity == "error" for problem in problems):
        msg = f"the selector '{visible(words)}' cannot be used"
        raise click.UsageError(msg)
    return selection


def finish(checked: Checked, *, strict: bool = False) -> NoReturn:
    """End with the status that the findings ask for."""
    sys.exit(status(checked.findings, strict=strict))


@contextmanager
def phrased() -> Iterator[None]:
    """Turn what can go wrong while writing into one line for the user."""
    from archgen.emit.tree import OutputError
    from archgen.findings.escape import visible

    try:
        yield
    except OutputError as error:
        message = f"{error.message}; {error.help}" if error.help else error.message
        raise click.ClickException(visible(message)) from None
    except OSError as error:
        raise click.ClickException(f"{error.strerror or error}: {error.filename or ''}".rstrip(": ")) from None


def read_bytes(path: Path, most: int) -> bytes:
    """Read a file, or the standard input for `-`. At most one byte more than `max_bytes`, so the caller sees what is
    too long.
    """
    try:
        if str(path) == "-":
            return sys.stdin.buffer.read(most + 1)
        with path.open("rb") as stream:
            return stream.read(most + 1)
    except OSError as error:
        msg = f"cannot read {path}: {error.strerror or error}"
        raise click.ClickException(msg) from None


def counted(findings: Sequence[Diagnostic]) -> str:
    """Count findings in words; empty where there are none."""
    from archgen.findings.text import summary

    return summary(findings) if findings else ""


def warn(said: str) -> None:
    """Print a warning, such as what an output could not show as asked."""
    from archgen.findings.escape import visible

    click.echo(f"warning: {visible(said)}", err=True)


def wrote(path: Path, detail: str = "") -> None:
    """Print what was written, relative to the current folder where that is shorter."""
    click.echo(f"wrote {shown(path)}{f' ({detail})' if detail else ''}")


def shown(path: Path) -> Path:
    """Return a path relative to the current folder if it is below it."""
    try:
        return path.resolve().relative_to(Path.cwd())
    except ValueError:
        return path


def progress(doing: str = "drawing") -> Callable[[int, int], None] | None:
    """Return a function that shows progress on a terminal, as done of total; None where the error stream is not a
    terminal.
    """
    if not sys.stderr.isatty():
        return None
    # A list, so that the inner function can change it.
    last = [0.0]

    def show(done: int, total: int) -> None:
        now = time.monotonic()
        if done < total and now - last[0] < 0.1:  # noqa: PLR2004 - ten times a second is enough for the eye
            return
        last[0] = now
        end = "\r\x1b[K" if done >= total else ""
        sys.stderr.write(f"\r\x1b[K{doing}: {done} of {total}{end}")
        sys.stderr.flush()

    return show
