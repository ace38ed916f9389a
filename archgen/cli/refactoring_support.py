"""What `rename`, `move` and `split` share: options, the project with its index, refusals, output, writing."""

from __future__ import annotations

import json
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import click

from archgen.cli import command_support, element_adding, shared_options
from archgen.cli.shared_options import CommandFunction
from archgen.diagnostics import did_you_mean, make_visible

if TYPE_CHECKING:
    from archgen.edit.refactoring.judged_version import JudgedVersion
    from archgen.edit.refactoring.refactoring import Refactoring


def add_shared_options(function: CommandFunction) -> CommandFunction:
    """Add the options that all of them have."""
    for option in (
        shared_options.project_option,
        click.option("--format", "format_name", type=click.Choice(("text", "json")), default="text", show_default=True),
        click.option("--dry-run", is_flag=True, help="Print the difference and write nothing."),
    ):
        function = option(function)
    return function


def read_kind(text: str | None) -> str | None:
    """Return the kind that `--kind` names, None where it is not given. Raise UsageError for a word that is none."""
    from archgen.schema.written_names import DECLARING_PARTS

    kinds = {kind.removesuffix("_declaration"): kind for kind in DECLARING_PARTS.values()}
    word = text and text.replace(" ", "_").replace("-", "_")
    if word is not None and word not in kinds:
        raise click.UsageError(f"no kind `{text}`: {did_you_mean(word, kinds) or ', '.join(sorted(kinds))}")
    return None if word is None else kinds[word]


def run_refactoring(
    project: Path | None,
    plan: Callable[[JudgedVersion], tuple[str, Refactoring]],
    format_name: str,
    *,
    dry_run: bool,
) -> None:
    """Plan, print and write a refactoring of the project at a path. One that is refused ends with the reason."""
    from archgen.edit.element_edit import EditRefusedError
    from archgen.edit.refactoring.judged_version import judge_version
    from archgen.products.written_edits import write_edits
    from archgen.project import ProjectNotFoundError, load_project

    try:
        version = judge_version(load_project(project))
    except ProjectNotFoundError as error:
        raise click.ClickException(str(error)) from None
    root = version.project.root
    try:
        title, refactoring = plan(version)
    except EditRefusedError as refusal:
        if format_name == "json":
            _print_json(
                {
                    "refused": refusal.message,
                    "help": refusal.by_hand,
                    "errors": [f"{e.span}: {e.message}" for e in refusal.errors],
                }
            )
            sys.exit(2)
        element_adding.raise_refusal(version.project, refusal)
    is_undoable = False
    if not dry_run:
        with command_support.explain_write_errors():
            is_undoable = write_edits(root, refactoring.edits, title)
    if format_name == "json":
        pairs = refactoring.renamed.pairs.items()
        _print_json(
            {
                "title": title,
                "written": not dry_run,
                "renamed": [{"kind": kind, "from": old_id, "to": new_id} for (kind, old_id), (_, new_id) in pairs],
                "files": [{"file": edit.file, "diff": "".join(edit.unified_diff())} for edit in refactoring.edits],
                "notes": list(refactoring.notes),
            }
        )
        return
    for line in _describe_files(root, title, refactoring, dry_run=dry_run):
        click.echo(make_visible(line))
    for note in refactoring.notes:
        click.echo(make_visible(note), err=dry_run)
    if not dry_run:
        click.echo("`archgen undo` takes it back." if is_undoable else "There is no cache folder: it cannot be undone.")


def _describe_files(root: Path, title: str, refactoring: Refactoring, *, dry_run: bool) -> Iterator[str]:
    """Yield the lines of a patch, or the title with the files."""
    if dry_run:
        yield from (line.rstrip() for edit in refactoring.edits for line in edit.unified_diff())
        return
    count = len(refactoring.edits)
    yield f"{title}: {count} file{'s' * (count != 1)}"
    for edit in refactoring.edits:
        yield f"  {command_support.shorten_path(root / edit.file)}:{edit.line}"


def _print_json(document: object) -> None:
    click.echo(json.dumps(document, indent=2, ensure_ascii=False))
