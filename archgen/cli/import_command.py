"""`archgen import`: take over the models of other tools, and bring them up to date."""

from __future__ import annotations

import json
import os
import re
import sys
from collections.abc import Iterable, Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import click

from archgen.cli import command_support, shared_options
from archgen.diagnostics import did_you_mean, make_visible
from archgen.importers.foreign_import import ForeignFileError
from archgen.importers.import_formats import ImportFormat, guess_format, list_import_formats

if TYPE_CHECKING:
    from archgen.edit.import_merge import ImportChange
    from archgen.edit.imported_slices import ImportPlan
    from archgen.importers.foreign_import import ForeignImport, ImportNote

_NAME_WIDTH = 9
_Mode = Literal["write", "dry-run", "check"]
_LAUNCH_ARGUMENT = re.compile(r"([A-Za-z_][^\s:=]*):=(.*)", re.DOTALL)


class _ImportCommand(click.Command):
    """A verb whose help ends with the formats: plug-ins tell them, and are asked when somebody reads it."""

    def format_epilog(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        """Write the formats with what they are, and who brings those that do not ship."""
        lines = [
            f"  {known.name:{_NAME_WIDTH}} {known.summary}{f' [{known.origin}]' if known.origin else ''}"
            for known in list_import_formats().values()
        ]
        self.epilog = "\b\n" + "\n".join(lines)
        super().format_epilog(ctx, formatter)


@click.command("import", cls=_ImportCommand)
@click.argument("words", metavar="[FORMAT] FILE... [NAME:=VALUE...]", nargs=-1, required=True)
@click.option(
    "-o",
    "--output",
    metavar="FOLDER",
    type=click.Path(path_type=Path, file_okay=False),
    help="Where the slices go: a project, a folder in one, or a new one.  [default: the project]",
)
@click.option("--merge", is_flag=True, help="Bring slices of the same file up to date; all else in them stays.")
@click.option(
    "--into", type=click.Path(path_type=Path), help="The slice of requirements (reqif).  [default: requirements.yaml]"
)
@click.option(
    "--launch",
    "launch_files",
    metavar="PACKAGE/FILE",
    multiple=True,
    help="The launch file that starts the robot (workspace). What only some of several start stands in variants; `none`: each program.",
)
@click.option(
    "--env", "variables", metavar="NAME=VALUE", multiple=True, help="A variable of the environment of launch files."
)
@click.option("--distro", metavar="NAME", default="", help="The distribution of ROS (workspace).")
@click.option(
    "--group-by",
    type=click.Choice(["folder", "package", "namespace", "codeowners"]),
    help="What makes a group of a workspace's nodes.  [default: the folder of their packages, else their namespace]",
)
@click.option("--dry-run", is_flag=True, help="Say what would be taken, and write nothing.")
@click.option(
    "--check",
    "checks",
    is_flag=True,
    help="Like --merge --dry-run, and end with 1 where slices are older than their source.",
)
@click.option(
    "--format", "form", type=click.Choice(["text", "json"]), default="text", help="How to say what was taken."
)
@shared_options.project_option
def command(  # noqa: PLR0913, PLR0917 - one for each option
    words: tuple[str, ...],
    output: Path | None,
    into: Path | None,
    launch_files: tuple[str, ...],
    variables: tuple[str, ...],
    distro: str,
    group_by: str | None,
    form: str,
    project: Path | None,
    *,
    merge: bool,
    dry_run: bool,
    checks: bool,
) -> None:
    """Take over a model of another tool: what it says becomes slices, and what is not taken is listed with its place.

    FORMAT may be left out where the file's name tells it. NAME:=VALUE sets an argument of launch files. Nothing that is there is overwritten, nothing of the file is
    run, and nothing is invented: what it does not say is absent.
    """
    file_words, arguments = _take_arguments(words)
    import_format, files = _split_words(file_words)
    if arguments and not import_format.takes_arguments:
        msg = f"{import_format.name} takes no arguments such as {next(iter(arguments))}:=..., as launch files do"
        raise click.UsageError(make_visible(msg))
    given: dict[str, Any] = {"arguments": arguments} if import_format.takes_arguments else {}
    if import_format.takes_environment:
        given["environment"] = command_support.split_words(
            variables, "=", "variable of the environment", "--env NAME=VALUE"
        )
    else:
        _refuse_options(import_format, {"--env": variables})
    if import_format.takes_launch_files:
        given |= {"launch_files": launch_files, "distro": distro, "group_by": group_by}
    else:
        _refuse_options(import_format, {"--launch": launch_files, "--distro": distro, "--group-by": group_by})
    if import_format.has_requirements:
        from archgen.cli.requirement_import import import_requirements

        _refuse_options(
            import_format, {"--output": output, "--merge": merge, "--check": checks, "--format": form != "text"}
        )
        if len(files) != 1:
            raise click.UsageError("one file of requirements is taken at a time")
        import_requirements(import_format, files[0], into, project, dry_run=dry_run)
        return
    _refuse_options(import_format, {"--into": into})
    target = _find_target(output, project)
    words = (*(f"{name}:={value}" for name, value in arguments.items()), *launch_files, *variables)
    mode: _Mode = "check" if checks else "dry-run" if dry_run else "write"
    _import_slices(import_format, files, given, words, target, form, merge=merge or checks, mode=mode)


def _take_arguments(words: Sequence[str]) -> tuple[list[str], dict[str, str]]:
    """Return the words without launch arguments, and these by name: the last value counts, as for `ros2 launch`."""
    matches = [None if _is_there(word) else _LAUNCH_ARGUMENT.fullmatch(word) for word in words]
    files = [word for word, match in zip(words, matches, strict=True) if match is None]
    if not files:
        raise click.UsageError("name a file, too")
    return files, {match[1]: match[2] for match in matches if match is not None}


def _split_words(words: Sequence[str]) -> tuple[ImportFormat, list[Path]]:
    """Return the format, named or guessed, and the files."""
    known_formats = list_import_formats()
    named = known_formats.get(words[0])
    if named and len(words) > 1:
        return named, _find_files(words[1:])
    if len(words) > 1 and not _is_there(words[0]):
        _refuse_format(words[0], known_formats)
    files = _find_files(words)
    formats = {known.name: known for file in files if (known := guess_format(file, known_formats))}
    if len(formats) == 1:
        return next(iter(formats.values())), files
    reason = "they are of several formats" if formats else f"its name does not tell the format of {files[0]}"
    raise click.UsageError(make_visible(f"{reason}: name it first, one of {', '.join(known_formats)}"))


def _refuse_format(word: str, known_formats: Iterable[str]) -> None:
    guess = did_you_mean(word, known_formats)
    msg = f"there is no file and no format `{word}`; {guess or 'formats are ' + ', '.join(known_formats)}"
    raise click.UsageError(make_visible(msg))


def _find_files(words: Sequence[str]) -> list[Path]:
    for word in words:
        if not _is_there(word):
            raise click.UsageError(make_visible(f"there is no file {word}"))
    return [Path(word) for word in words]


def _is_there(word: str) -> bool:
    try:
        return Path(word).exists()
    except OSError:
        # Longer than a name can be: the value of an argument, or nothing.
        return False


def _refuse_options(import_format: ImportFormat, given_options: dict[str, object]) -> None:
    for option, value in given_options.items():
        if value:
            raise click.UsageError(f"{option} does not go with {import_format.name}")


def _find_target(output: Path | None, project: Path | None) -> Path:
    from archgen.project import PROJECT_FILE, ProjectNotFoundError
    from archgen.project.project_search import find_project

    if output is not None:
        return project / output if project is not None and not output.is_absolute() else output
    try:
        root, first_file = find_project(project)
    except ProjectNotFoundError:
        raise click.UsageError("there is no project here: `-o FOLDER` makes a new one of the model") from None
    if first_file != PROJECT_FILE:
        msg = "a project of a single file reads no slices: put it into a folder as archgen.yaml first, or name another by `-o`"
        raise click.UsageError(msg)
    return root


def _import_slices(  # noqa: PLR0913, PLR0917 - what, where and how
    import_format: ImportFormat,
    files: list[Path],
    given: dict[str, Any],
    shown_arguments: tuple[str, ...],
    target: Path,
    form: str,
    *,
    merge: bool,
    mode: _Mode,
) -> None:
    from archgen.edit.earlier_import import ImportOrigin
    from archgen.edit.imported_slices import ImportRefusedError, find_known_ids, plan_import

    names = tuple(file.resolve().name for file in files)
    origin = ImportOrigin(import_format.name, names, shown_arguments, import_format.has_dated_files)
    known_ids = find_known_ids(origin, target) if merge and import_format.keeps_ids else {}
    imported = _read_model(import_format, files, given, known_ids)
    if not imported.slices:
        _print_account(imported, None, form)
        click.echo("Nothing was written: there is nothing in it that archgen takes.", err=True)
        raise click.exceptions.Exit(1)
    try:
        plan = plan_import(imported, origin, target, merge=merge)
    except ImportRefusedError as refusal:
        for diagnostic in refusal.diagnostics:
            _print_problem(str(diagnostic.span), diagnostic.message, diagnostic.help or "")
        raise click.ClickException(make_visible(refusal.message)) from None
    _print_account(imported, plan, form, is_written=mode == "write")
    if mode == "write":
        # A recording says what was once: it does not change, the next one has another name.
        _write_plan(plan, [] if import_format.has_dated_files else files, quiet=form == "json")
    _print_outcome(plan)
    if plan.errors or (mode == "check" and plan.is_out_of_date):
        raise click.exceptions.Exit(1)


def _read_model(
    import_format: ImportFormat, files: list[Path], given: dict[str, Any], known_ids: dict[str, str]
) -> ForeignImport:
    try:
        ids = {"known_ids": known_ids} if import_format.keeps_ids else {}
        imported: ForeignImport = import_format.load_reader()(files, **given, **ids)
    except ForeignFileError as error:
        _print_problem(str(error.span), error.message, error.help_line)
        click.echo("Nothing was written.", err=True)
        raise click.exceptions.Exit(1) from None
    return imported


def _print_problem(place: str, message: str, help_line: str) -> None:
    click.echo(make_visible(f"error: {place}: {message}"), err=True)
    if help_line:
        click.echo(make_visible(f"  = help: {help_line}"), err=True)


def _print_account(imported: ForeignImport, plan: ImportPlan | None, form: str, *, is_written: bool = False) -> None:
    """Print what was taken, and each construct that was not, with its place."""
    if form == "json":
        click.echo(json.dumps(_make_record(imported, plan), indent=2, ensure_ascii=True))
        return
    taken = ", ".join(f"{count} {kind}" for kind, count in sorted(imported.taken.items()))
    click.echo(make_visible(f"taken: {taken or 'nothing'}"))
    for note in imported.notes:
        click.echo(make_visible(f"  {note.fate}: {note.span}: {note.kind}: {note.message}"))
        if note.help_line:
            click.echo(make_visible(f"    = help: {note.help_line}"))
    for line in _summarise_slices(plan, is_written=is_written) if plan else ():
        click.echo(make_visible(line))


def _make_record(imported: ForeignImport, plan: ImportPlan | None) -> dict[str, Any]:
    return {
        "taken": dict(sorted(imported.taken.items())),
        "notes": [_make_note_record(note) for note in imported.notes],
        "files": [
            {
                "file": planned.file,
                "new": planned.is_new,
                "changed": planned.is_changed,
                "changes": [_make_change_record(change) for change in planned.changes],
            }
            for planned in (plan.slices if plan else ())
        ],
        "renamed": dict(plan.renames) if plan else {},
        "differences": list(plan.differences) if plan else [],
    }


def _make_change_record(change: ImportChange) -> dict[str, Any]:
    words = {"before": change.before, "now": change.now, "mine": change.mine}
    place = {"line": change.span.line, "column": change.span.column} if change.span else {}
    return {"kind": change.kind, "path": ".".join(change.path), **words, **place}


def _make_note_record(note: ImportNote) -> dict[str, Any]:
    return {
        "fate": note.fate,
        "kind": note.kind,
        "count": note.count,
        "message": note.message,
        "help": note.help_line,
        "file": note.span.file,
        "line": note.span.line,
        "column": note.span.column,
    }


def _summarise_slices(plan: ImportPlan, *, is_written: bool) -> Iterator[str]:
    renewed = "brought up to date" if is_written else "would be brought up to date"
    for planned in plan.slices:
        if not planned.is_new:
            yield f"{planned.file}: {renewed if planned.is_changed else 'as before'}"
            yield from (f"  {change.describe()}" for change in planned.changes)
            if not planned.has_record:
                yield "  what the last import said is not known: nothing is taken away, and what stands there stays"
            if planned.is_left:
                yield "  nothing of it is in the model any more: take it out if it is gone"
        if planned.is_rewritten:
            yield "  written anew: comments could not stay in their places, and stand at the beginning"
    yield from (f"renamed: {place} is {name} by now; its id stays" for place, name in plan.renames.items())
    yield from (f"said otherwise by another file, which stays as it is: {each}" for each in plan.differences)
    for place, old_place in plan.moves.items():
        yield f"the model has {old_place} as {place} by now: it stays where it is"


def _write_plan(plan: ImportPlan, sources: Sequence[Path], *, quiet: bool) -> None:
    from archgen.edit.earlier_import import write_source_records
    from archgen.emit import new_files
    from archgen.emit.file_tree import replace_file
    from archgen.regular_files import holds_bytes

    new = {plan.root / planned.file: planned.text.encode() for planned in plan.slices if planned.is_new}
    changed = [planned for planned in plan.slices if not planned.is_new and planned.is_changed]
    with command_support.explain_write_errors():
        slices = [planned.file for planned in plan.slices if planned.records]
        texts = {path: text for planned in plan.slices for path, text in planned.records.items()}
        texts |= write_source_records(plan.root, slices, sources) if sources else {}
        records = {plan.root / path: text.encode() for path, text in texts.items()}
        for path in records:
            new_files.refuse_outside(path.parent, plan.root)
        # Of a slice that is new before it: while the slice is not there, the next run does all of it again.
        first = {path: data for path, data in records.items() if new and not os.path.lexists(path)}
        new_files.write_new_files(first | new, plan.root)
        for planned in changed:
            replace_file(plan.root / planned.file, planned.text.encode())
        # Of others last: where something fails before, the next import knows what the one before it said.
        for path, data in records.items():
            if not holds_bytes(path, data):
                path.parent.mkdir(parents=True, exist_ok=True)
                replace_file(path, data)
    for path in () if quiet else (*new, *(plan.root / planned.file for planned in changed)):
        command_support.print_written(path)


def _print_outcome(plan: ImportPlan) -> None:
    """Print errors that came with the import, and what is left to do."""
    if plan.errors:
        command_support.print_findings(plan.errors, plan.checked_project, sys.stderr)
        command_support.print_warning("these errors are in what the model says: mend them there, or in the slices")
    for file in plan.unread_files:
        command_support.print_warning(f"the project does not read {file} yet: add it to `sources` in archgen.yaml")
