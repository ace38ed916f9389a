"""What commands have in common: check a project, print findings and written files, show progress, end with a status."""

from __future__ import annotations

import math
import os
import sys
import time
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING, NoReturn, TextIO, TypeVar

import click

from archgen.cli.shared_options import find_asked_variants
from archgen.diagnostics import (
    Diagnostic,
    Severity,
    did_you_mean,
    join_first,
    make_visible,
    settle_diagnostics,
    sort_gravest_first,
)
from archgen.diagnostics.text_columns import find_width

if TYPE_CHECKING:
    from collections.abc import Iterable

    from archgen.diagnostics import SourceTexts
    from archgen.edit.element_edit import FileEdit
    from archgen.edit.measured_slice import MeasuredSlice
    from archgen.edit.requirement_slice import RequirementSlice
    from archgen.model.architecture import Architecture, Partner
    from archgen.model.selector_evaluation import Selection
    from archgen.model.selector_parser import SelectorProblem
    from archgen.pipeline import CheckedProject, VersionCache
    from archgen.products.output_options import OutputOptions
    from archgen.products.trusted_backends import TrustedRevision
    from archgen.views.changes.site_changes import SiteChanges
    from archgen.views.pages.report_outline import DetailLevel

FormatName = TypeVar("FormatName", bound=str)


def check_or_exit(project: Path | None, version_cache: VersionCache | None = None) -> CheckedProject:
    """Check a project, as it stands in the variants that `--variant` names. It is wrong usage if there is none."""
    from archgen import pipeline
    from archgen.project import ProjectNotFoundError

    names = find_asked_variants()
    with explain_wrong_usage(ProjectNotFoundError):
        checked_project = pipeline.check_project(project, version_cache, names or None)
    return stand_or_exit(checked_project, names) if names else checked_project


def stand_or_exit(checked_project: CheckedProject, names: Sequence[str]) -> CheckedProject:
    """Return a checked project as it stands in variants. It is wrong usage if it has one of them not."""
    from archgen import pipeline

    with explain_wrong_usage(pipeline.UnknownVariantError):
        return pipeline.stand_in_variants(checked_project, names)


def find_trusted_revision(
    project: Path | None, revision: str | None, version_cache: VersionCache | None = None
) -> TrustedRevision | None:
    """Read what a revision says about the project's own backends; None if none is given: then all may run."""
    if not revision:
        return None
    from archgen import git
    from archgen.products import trusted_backends

    with explain_wrong_usage(git.GitError):
        return trusted_backends.read_trusted_revision(project, revision, version_cache)


def print_findings_above(checked_project: CheckedProject, *, lowest_severity: Severity = Severity.WARNING) -> None:
    """Print findings from a severity on, and their count, to the error stream."""
    shown_findings = [d for d in checked_project.findings if d.effective_severity >= lowest_severity]
    if shown_findings:
        print_findings(shown_findings, checked_project, sys.stderr)


def print_findings(findings: Sequence[Diagnostic], checked_project: CheckedProject, stream: TextIO) -> None:
    """Print a project's findings for people, the gravest first, as wide as the terminal."""
    is_waiting = bool(checked_project.waiting_rules)
    print_excerpts(sort_gravest_first(findings), checked_project.sources, stream, is_waiting=is_waiting)


def print_excerpts(
    findings: Sequence[Diagnostic], sources: SourceTexts, stream: TextIO, *, is_waiting: bool = False
) -> None:
    """Print findings with the lines of these sources. `is_waiting` is whether rules wait for errors to be mended."""
    from archgen.emit.terminal import findings_text

    colour = findings_text.wants_colour(stream, os.environ)
    lines = findings_text.render_findings_text(
        findings, sources, colour=colour, width=find_width(stream), is_waiting=is_waiting
    )
    stream.writelines(f"{line}\n" for line in lines)


def exit_status(findings: Sequence[Diagnostic], *, strict: bool = False) -> int:
    """Return the exit status for findings: 1 with errors (`strict`: or warnings), else 0."""
    failing_severities = {Severity.ERROR, Severity.WARNING} if strict else {Severity.ERROR}
    return 1 if any(finding.severity in failing_severities for finding in findings) else 0


def check_before_writing(project: Path | None, *, keep_going: bool) -> CheckedProject:
    """Check a project before something is written. Errors are printed and, without --keep-going, end the run."""
    checked_project = check_or_exit(project)
    print_findings_above(checked_project, lowest_severity=Severity.ERROR)
    if exit_status(checked_project.findings) and not keep_going:
        click.echo("Nothing was written. With --keep-going outputs are made of what is sound.", err=True)
        sys.exit(1)
    return checked_project


def select_or_exit(checked_project: CheckedProject, selector_text: str | None) -> Selection | None:
    """Evaluate a selector from the command line. What names nothing is wrong usage."""
    if selector_text is None:
        return None
    from archgen.products import project_views

    selection, problems = project_views.select_elements(checked_project, selector_text)
    report_selector_problems(problems)
    return selection


def make_drawing_options(
    checked_project: CheckedProject, selector_text: str | None, level: DetailLevel | None, revision: str | None = None
) -> OutputOptions:
    """Return what all outputs with pictures share: the selected part, and progress and warnings on this terminal."""
    from archgen.products.output_options import OutputOptions

    selection = select_or_exit(checked_project, selector_text)
    return OutputOptions(selection, selector_text or "", level, revision, make_progress_printer(), print_warning)


def report_selector_problems(problems: Iterable[SelectorProblem]) -> None:
    """Print what is odd about a selector; what is wrong is wrong usage."""
    errors = []
    for problem in problems:
        text = f"{problem.message}; {problem.help}" if problem.help else problem.message
        if problem.severity == "error":
            errors.append(make_visible(text))
        else:
            print_warning(text)
    if errors:
        raise click.UsageError("\n".join(errors))


def exit_by_findings(checked_project: CheckedProject) -> NoReturn:
    """End with the status that the findings ask for."""
    sys.exit(exit_status(checked_project.findings))


@contextmanager
def explain_write_errors() -> Iterator[None]:
    """Turn what can go wrong while writing into one line for the user."""
    from archgen.emit.file_tree import OutputError

    try:
        yield
    except OutputError as error:
        message = f"{error.message}; {error.help}" if error.help else error.message
        raise click.ClickException(make_visible(message)) from None
    except OSError as error:
        raise click.ClickException(f"{error.strerror or error}: {error.filename or ''}".rstrip(": ")) from None


@contextmanager
def explain_wrong_usage(*kinds: type[Exception]) -> Iterator[None]:
    """Turn errors of some kinds into wrong usage."""
    try:
        yield
    except kinds as error:
        raise click.UsageError(make_visible(str(error))) from None


@contextmanager
def explain_missing_versions() -> Iterator[None]:
    """Turn versions that cannot be found into wrong usage."""
    from archgen.git import GitError, NoRepositoryError
    from archgen.project import ProjectNotFoundError

    try:
        yield
    except NoRepositoryError as error:
        raise click.UsageError(make_visible(f"{error}, or name two folders or files to compare")) from None
    except (GitError, ProjectNotFoundError) as error:
        raise click.UsageError(make_visible(str(error))) from None


def compare_since(since: str | None, project: Path | None, checked_project: CheckedProject) -> SiteChanges | None:
    """Return what changed since a version, None where none is named."""
    if since is None:
        return None
    from archgen.products import comparison_documents

    with explain_missing_versions():
        return comparison_documents.compare_since(since, project, checked_project)


def read_input(path: Path, max_bytes: int) -> bytes:
    """Read a file, or the standard input for `-`. At most one byte more than `max_bytes`, so the caller sees what is
    too long.
    """
    try:
        if str(path) == "-":
            return sys.stdin.buffer.read(max_bytes + 1)
        with path.open("rb") as stream:
            return stream.read(max_bytes + 1)
    except OSError as error:
        raise click.ClickException(f"cannot read {path}: {error.strerror or error}") from None


def summarise_counts(findings: Sequence[Diagnostic]) -> str:
    """Count findings in words; empty where there are none."""
    from archgen.emit.terminal.findings_text import format_summary

    return format_summary(findings) if findings else ""


def print_warning(text: str) -> None:
    """Print a warning, such as what an output could not show as asked."""
    click.echo(f"warning: {make_visible(text)}", err=True)


def choose_format(
    format_name: FormatName | None, output: Path | None, formats: Mapping[str, FormatName], default: FormatName
) -> FormatName:
    """Return the format that was asked for, else that of the file's ending; the default where nothing is said.

    `formats` are the formats by their endings (`.docx`). Raise UsageError where another ending names none of them: a Word
    file that is called report.odt opens nowhere.
    """
    ending = output.suffix.lower() if output is not None else ""
    if format_name or not ending:
        return format_name or default
    if ending not in formats:
        *others, last = formats
        advice = f"{', '.join(others)} or {last}, or give --format" if others else last
        raise click.UsageError(make_visible(f"the ending of `{output}` names no format: end it in {advice}"))
    return formats[ending]


def write_edit(root: Path, edit: FileEdit, detail: str) -> None:
    """Write an edited file of the project in a folder, and print that."""
    from archgen.emit import file_tree

    target = (root / edit.file).resolve()
    with explain_write_errors():
        file_tree.write_file(target, edit.new_content)
    print_written(root / edit.file, detail)


def print_diff(edit: FileEdit) -> None:
    """Print what an edit changes in a file, with control characters made visible."""
    sys.stdout.writelines(f"{make_visible(line.rstrip())}\n" for line in edit.unified_diff())


def write_output(document: str | bytes, output: Path | None) -> None:
    """Write a document to a file, all of it or nothing, or to standard output."""
    from archgen.emit import file_tree

    if output is not None:
        # Colours depend on the terminal, and belong into no file.
        file_tree.write_file(output, document if isinstance(document, bytes) else click.unstyle(document).encode())
        print_written(output)
    elif isinstance(document, bytes):
        sys.stdout.buffer.write(document)
    else:
        sys.stdout.write(document)


def write_slice(path: Path, made_slice: RequirementSlice | MeasuredSlice, advice: str, detail: str | None = "") -> None:
    """Write a slice that was made of another file, and print that, unless `detail` is None. `advice` is for a refusal."""
    from archgen.emit.file_tree import OutputError, write_file

    try:
        write_file(path, made_slice.text.encode())
    except OutputError as error:
        raise click.ClickException(make_visible(f"{error.message}; nothing was changed; {advice}")) from None
    if detail is not None:
        print_written(path, detail)
    if not made_slice.is_read:
        print_warning(f"the project does not read it yet: add `{made_slice.file}` to `sources` in archgen.yaml")


def print_written(path: Path, detail: str = "") -> None:
    """Print what was written, relative to the current folder where that is shorter."""
    click.echo(f"wrote {shorten_path(path)}{f' ({detail})' if detail else ''}")


def shorten_path(path: Path) -> Path:
    """Return a path relative to the current folder if it is below it."""
    try:
        return path.resolve().relative_to(Path.cwd())
    except ValueError:
        return path


_LONG_WORK = 3.0
"""Seconds after which it is worth saying how long the rest takes."""
_SECONDS_PER_MINUTE = 60


def describe_time_left(seconds: float, done: int, total: int) -> str:
    """Say how long work that has taken some seconds goes on if all of it is alike; nothing for short work."""
    if not 0 < done < total or seconds < _LONG_WORK:
        return ""
    left = math.ceil(seconds * (total - done) / done)
    words = f"{left} s" if left < 2 * _SECONDS_PER_MINUTE else f"{math.ceil(left / _SECONDS_PER_MINUTE)} min"
    return f", some {words} left"


def make_progress_printer(label: str = "drawing") -> Callable[[int, int], None] | None:
    """Return a function that shows progress on a terminal, as done of total; None where the error stream is not a
    terminal.
    """
    if not sys.stderr.isatty():
        return None
    # A list, so that the inner function can change it.
    last_shown = [0.0]
    begin = time.monotonic()

    def show_progress(done: int, total: int) -> None:
        now = time.monotonic()
        if done < total and now - last_shown[0] < 0.1:  # noqa: PLR2004 - ten times a second is enough for the eye
            return
        last_shown[0] = now
        end = "\r\x1b[K" if done >= total else ""
        left = describe_time_left(now - begin, done, total)
        sys.stderr.write(f"\r\x1b[K{label}: {done} of {total}{left}{end}")
        sys.stderr.flush()

    return show_progress


def find_repository_folder(folder: Path, default: Path | None = None) -> Path:
    """Return the folder of the repository around a folder, else the default, else the folder itself."""
    resolved = folder.resolve()
    # lexists: in a worktree or submodule `.git` is a file.
    found = (each for each in (resolved, *resolved.parents) if os.path.lexists(each / ".git"))
    return next(found, default or resolved)


def split_words(words: Iterable[str], joint: str, what: str, example: str) -> dict[str, str]:
    """Return words such as `NAME=VALUE` by their names. Raise UsageError for one that is none, with an example."""
    pairs = {}
    for word in words:
        name, found, value = word.partition(joint)
        if not name or not found:
            raise click.UsageError(make_visible(f"`{word}` is no {what}: write `{example}`"))
        pairs[name] = value
    return pairs


def require_host(architecture: Architecture, host: str) -> None:
    """Raise UsageError where a project has no host of this id."""
    if host not in architecture.hosts:
        known = f"the hosts are {', '.join(architecture.hosts)}" if architecture.hosts else "the project has no hosts"
        raise click.UsageError(
            make_visible(f"there is no host '{host}'; {did_you_mean(host, architecture.hosts) or known}")
        )


def require_partner(architecture: Architecture, name: str) -> Partner:
    """Return a partner by his id. Raise UsageError where a project has none of this id."""
    partners = architecture.partners
    if name not in partners:
        known = f"the partners are {join_first(list(partners), 8)}" if partners else "the project has no partners"
        guess = did_you_mean(name, partners) or known
        raise click.UsageError(make_visible(f"there is no partner '{name}'; {guess}"))
    return partners[name]


def settle_problems(problems: Iterable[Diagnostic]) -> tuple[Diagnostic, ...]:
    """Return what is wrong with files that are no part of the project, with the severities of the rules."""
    from archgen.pipeline import index_all_rules

    return settle_diagnostics(problems, index_all_rules(), {})


def find_asked_files(paths: tuple[Path, ...], project: Path | None) -> tuple[Path | None, tuple[Path, ...]]:
    """Return the project that is asked for, and the files of it that alone are; none for all."""
    if not paths:
        return project, ()
    if project is not None:
        other_paths = [path for path in paths if not os.path.isfile(path)]  # noqa: PTH113 - Path.is_file may raise
        if other_paths:
            raise click.UsageError(f"the project is named twice: {other_paths[0]} and -C {project}")
        return project, paths
    from archgen.project.project_search import PROJECT_FILE, find_project_of_slice

    if len(paths) == 1:
        folder = find_project_of_slice(paths[0])
        return folder or paths[0], paths if folder else ()
    folders = [path.resolve().parent if path.name == PROJECT_FILE else find_project_of_slice(path) for path in paths]
    if folders[0] is None or any(folder != folders[0] for folder in folders):
        raise click.UsageError(f"these are not files of one project: {', '.join(map(str, paths))}")
    return folders[0], paths


def name_files(checked_project: CheckedProject, files: Iterable[Path]) -> dict[str, Path]:
    """Return files by what the project calls them: their path below its folder."""
    from archgen.project.project_search import name_path_from

    root = os.path.realpath(checked_project.root)
    return {name_path_from(root, os.path.realpath(file)): file for file in files}
