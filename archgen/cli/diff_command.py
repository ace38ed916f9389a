"""`archgen diff`: compare two versions of an architecture."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

import click

from archgen.cli import command_support, shared_options
from archgen.diagnostics import make_visible, sort_gravest_first
from archgen.products.output_options import OutputOptions

if TYPE_CHECKING:
    from archgen.compare import Comparison
    from archgen.products.compared_versions import ProjectVersion
    from archgen.products.repository_comparison import ComparedProject, ProjectComparison


def _read_versions(
    before: str | None, after: str | None, project: Path | None
) -> tuple[ProjectVersion, ProjectVersion]:
    """Read both versions. What cannot be found is wrong usage."""
    from archgen.products.compared_versions import read_versions

    with command_support.explain_missing_versions():
        return read_versions(before, after, project)


def _read_variants(
    before: str | None, after: str | None, project: Path | None, variants: Sequence[str]
) -> tuple[ProjectVersion, ProjectVersion]:
    """Read two versions as they stand in a variant, or one as it stands in two."""
    from archgen.products.compared_versions import read_variant, read_version

    if len(variants) > 2:  # noqa: PLR2004 - a comparison has two sides
        raise click.UsageError("`--variant` once is that of both versions; twice they are compared: not more often")
    names = [shared_options.split_variants(text) for text in variants]
    if len(names) == 1:
        old, new = (
            read_variant(version, command_support.stand_or_exit(version.checked_project, names[0]), names[0])
            for version in _read_versions(before, after, project)
        )
        return old, new
    if after is not None:
        raise click.UsageError("two variants are those of one version: name one, or none for the working tree")
    with command_support.explain_missing_versions():
        version = read_version(before, project)
    first, second = (
        read_variant(version, command_support.stand_or_exit(version.checked_project, each), each) for each in names
    )
    return first, second


def _select_changes(
    comparison: Comparison, old_version: ProjectVersion, new_version: ProjectVersion, selector: str | None
) -> Comparison:
    """Keep what touches the selected part of either version. What only one version has is selected there alone."""
    if selector is None:
        return comparison
    # Late: all views come along.
    from archgen.compare.select_changes import select_changes
    from archgen.model.selector_evaluation import Selection
    from archgen.products import project_views

    (old_selection, old_problems), (new_selection, new_problems) = (
        project_views.select_elements(side.checked_project, selector) for side in (old_version, new_version)
    )
    # A word that names nothing in one version may name something in the other: only what is wrong in both is wrong.
    common_problems = [
        problem for problem in new_problems if problem.message in {each.message for each in old_problems}
    ]
    command_support.report_selector_problems(common_problems)
    return select_changes(comparison, old_selection or Selection(), new_selection or Selection())


def _write_github(comparison: Comparison, new_version: ProjectVersion) -> str:
    from archgen.cli.finding_documents import folder_in_repository
    from archgen.emit.data.findings_data import format_github_commands
    from archgen.products.merge_breaks import find_breaks

    breaks = find_breaks(comparison, new_version.checked_project)
    findings = (*breaks, *sort_gravest_first(comparison.new_findings))
    folder = folder_in_repository(new_version.checked_project.root)
    return "".join(f"{line}\n" for line in format_github_commands(findings, folder=folder))


COMPARISON_FORMATS = ("text", "json", "markdown", "html", "github", "svg")


def _write_comparison(
    form: str, comparison: Comparison, old_version: ProjectVersion, new_version: ProjectVersion
) -> str | bytes:
    from archgen.emit.terminal.findings_text import wants_colour
    from archgen.products import comparison_documents as documents

    if form == "github":
        return _write_github(comparison, new_version)
    options = OutputOptions(warn=command_support.print_warning)
    if form == "svg":
        return documents.render_comparison_svg(comparison, options)
    versions = comparison, old_version, new_version
    if form == "html":
        return documents.render_comparison_html(*versions, options)
    if form == "text":
        return documents.render_comparison_text(*versions, colour=wants_colour(sys.stdout, os.environ))
    render = documents.render_comparison_json if form == "json" else documents.render_comparison_markdown
    return render(*versions)


def _find_unpushed_base(project: Path | None) -> str:
    """Return the commit from which on nothing was pushed. Where the remote has nothing yet, end with 0."""
    from archgen import git

    with command_support.explain_missing_versions():
        base = git.find_unpushed_base(git.find_repository(project or Path.cwd()))
    if base is None:
        click.echo("nothing to compare with: this clone knows no main line of `origin`", err=True)
        sys.exit(0)
    return base.commit_id


def _read_unpushed_versions(base: str, project: Path | None) -> tuple[ProjectVersion, ProjectVersion]:
    """Read HEAD and what the remote has of it. Where that is nothing yet, end with 0: nobody relies on a new project."""
    from archgen.products.compared_versions import read_versions
    from archgen.project import NotAtRevisionError
    from archgen.project.project_tracking import UnclearMoveError

    with command_support.explain_missing_versions():
        try:
            return read_versions(base, "HEAD", project)
        except UnclearMoveError:
            raise
        except NotAtRevisionError:
            click.echo("nothing to compare with: `origin` is without this project", err=True)
            sys.exit(0)


def _find_meant_project(before: str | None, after: str | None) -> Path | None:
    from archgen.git import GitError
    from archgen.products.compared_versions import find_meant_project

    try:
        return find_meant_project(before, after)
    except (GitError, OSError):  # said better by whoever reads the versions
        return None


def _list_compared_projects(before: str | None, after: str | None, project: Path | None) -> tuple[ComparedProject, ...]:
    from archgen.git import GitError
    from archgen.products.repository_comparison import list_compared_projects

    try:
        return list_compared_projects(project, before, after)
    except (GitError, OSError):  # said better by whoever reads the versions
        return ()


def _print_comparisons(comparisons: Sequence[ProjectComparison]) -> None:
    """Print a line for each project of a repository."""
    width = max(len(each.folder) for each in comparisons)
    for each in comparisons:
        click.echo(make_visible(f"{each.folder:{width}}  {each.summary}"))
    if any(each.has_changes for each in comparisons):
        click.echo("\n`archgen diff -C FOLDER` says what changed in a project.")


@click.command("diff")
@click.argument("before", required=False, metavar="[A]")
@click.argument("after", required=False, metavar="[B]")
@click.option("--format", "form", type=click.Choice(COMPARISON_FORMATS), default="text", show_default=True)
@click.option(
    "--breaking", is_flag=True, help="Show only what breaks another partner; end with 1 where the project forbids it."
)
@shared_options.file_option("The file to write.  [default: standard output]")
@click.option(
    "--variant",
    "variants",
    metavar="NAMES",
    multiple=True,
    help="Compare both as they stand in a variant; given twice, two variants of one version: `--variant base --variant sim`.",
)
@click.option(
    "--unpushed", is_flag=True, help="Compare HEAD with where it left the main line of `origin`: what a push brings."
)
@click.option("--exit-code", is_flag=True, help="End with 1 if there are changes, with 0 if there are none.")
@shared_options.select_option
@shared_options.project_option
def command(  # noqa: PLR0913 - the options of the verb, each by its name
    before: str | None,
    after: str | None,
    form: str,
    *,
    breaking: bool,
    output: Path | None,
    exit_code: bool,
    variants: tuple[str, ...],
    unpushed: bool,
    select: str | None,
    project: Path | None,
) -> None:
    """Compare two versions of the architecture: models, not lines.

    A and B are revisions of git (`main`, `v1.2`, `HEAD~3`), folders, or single or packed files. B left out is the working
    tree; A left out is the commit at which the branch left its main line. `A..B` and `A...B` mean what they mean to git.
    Order, comments, formatting and moves between files are no changes. In a folder that only holds projects, such as the
    top of a repository, each of them has a line: what changed, and in which library. With --variant twice, A is the version
    whose variants are compared, left out the working tree.
    """
    from archgen.compare.breaking_changes import keep_breaking_only
    from archgen.forge.reviewed_request import find_request_authors
    from archgen.products import compared_versions, repository_comparison

    if unpushed:
        if before is not None or variants:
            raise click.UsageError("--unpushed says what is compared: no A, no B, no --variant")
        before, after = _find_unpushed_base(project), "HEAD"
    project = project or _find_meant_project(before, after)
    projects = _list_compared_projects(before, after, project)
    if projects:
        if form != "text" or select is not None or output is not None or variants:
            msg = f"this folder only holds projects: name one with -C, such as `-C {projects[0].folder}`"
            raise click.UsageError(msg)
        with command_support.explain_missing_versions():
            comparisons = list(
                repository_comparison.compare_projects_below(project, projects, before, after, find_request_authors())
            )
        _print_comparisons(comparisons)
        is_refused = breaking and any(each.is_refused for each in comparisons)
        sys.exit(1 if is_refused or (exit_code and any(each.has_changes for each in comparisons)) else 0)
    if variants:
        old_version, new_version = _read_variants(before, after, project, variants)
    elif unpushed and before:
        old_version, new_version = _read_unpushed_versions(before, project)
    else:
        old_version, new_version = _read_versions(before, after, project)
    comparison = _select_changes(
        compared_versions.compare_named_versions(old_version, new_version, forge_facts=find_request_authors()),
        old_version,
        new_version,
        select,
    )
    if breaking:
        comparison = keep_breaking_only(comparison)
    with command_support.explain_write_errors():
        command_support.write_output(_write_comparison(form, comparison, old_version, new_version), output)
    sys.exit(1 if (exit_code and not comparison.is_empty) or (breaking and comparison.is_refused) else 0)
