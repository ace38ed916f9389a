"""From two compared versions to a document: text, JSON, Markdown for a pull request, an HTML page, or a picture.

Pages and pictures import late: `archgen diff` in a terminal needs neither.
"""

from __future__ import annotations

import shlex
from typing import TYPE_CHECKING

from archgen.compare import Comparison
from archgen.diagnostics import shorten_hash
from archgen.frozen import replace
from archgen.products.compared_versions import WORKING_TREE_NAME, ProjectVersion
from archgen.products.output_options import OutputOptions
from archgen.views.changes.comparison_document import ComparisonDocument, ReadingErrors, describe_comparison

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from archgen.emit.picture import Picture
    from archgen.pipeline import CheckedProject
    from archgen.views.changes.site_changes import SiteChanges
    from archgen.views.picture_shapes import Graph


def describe_versions(
    comparison: Comparison, old_version: ProjectVersion, new_version: ProjectVersion, graphs: tuple[Graph, ...] = ()
) -> ComparisonDocument:
    """Describe a comparison of two versions in the words of all formats."""
    return describe_comparison(
        comparison,
        old_version.title,
        new_version.title,
        find_reading_errors(old_version, new_version),
        graphs,
    )


def find_reading_errors(old_version: ProjectVersion, new_version: ProjectVersion) -> ReadingErrors:
    """Return what could not be read or linked in either version."""
    return ReadingErrors(old_version.checked_project.structural_errors, new_version.checked_project.structural_errors)


def render_comparison_text(
    comparison: Comparison, old_version: ProjectVersion, new_version: ProjectVersion, *, colour: bool
) -> str:
    """Write a comparison for the terminal."""
    from archgen.emit.terminal import comparison_text

    document = describe_versions(comparison, old_version, new_version)
    sources = old_version.checked_project.sources, new_version.checked_project.sources
    lines = comparison_text.write_comparison_lines(document, sources, colour=colour)
    return "".join(f"{line}\n" for line in lines)


def render_comparison_json(comparison: Comparison, old_version: ProjectVersion, new_version: ProjectVersion) -> str:
    """Write a comparison for programs."""
    from archgen.emit.data import comparison_json

    return comparison_json.write_comparison_json(comparison, find_reading_errors(old_version, new_version))


def render_comparison_markdown(
    comparison: Comparison, old_version: ProjectVersion, new_version: ProjectVersion, command: str = ""
) -> str:
    """Write a comparison as the comment on a pull request. `command` shows the same, by default that with the names."""
    from archgen.emit.markdown import comparison_markdown
    from archgen.views.graphs import changes as pictures

    graphs = pictures.draw_changes(comparison, pictures.SMALL_BUDGET)
    document = describe_versions(comparison, old_version, new_version, graphs)
    document = replace(document, element_addresses=_list_addresses(old_version, new_version))
    return comparison_markdown.write_comparison_markdown(
        document, command or _terminal_command(old_version, new_version)
    )


def _list_addresses(old_version: ProjectVersion, new_version: ProjectVersion) -> Mapping[str, str]:
    """Return where elements are written: in the commits that are compared, whose lines are those of the comparison."""
    from archgen.products.project_views import locate_repository
    from archgen.views.changes.named_elements import list_element_addresses

    # The later version says where the repository is, and where the project lies in it: the earlier one may not know yet.
    repository = locate_repository(new_version.checked_project)
    if repository is None:
        return {}
    old_side, new_side = (
        (version.checked_project.architecture, replace(repository, commit=version.commit))
        for version in (old_version, new_version)
    )
    return list_element_addresses(old_side, new_side)


def _terminal_command(old_version: ProjectVersion, new_version: ProjectVersion) -> str:
    """Return the command that shows the same comparison in a terminal."""
    # A name with a blank is a description of ours ("where this branch left main"), no revision that git understands.
    arguments = [shorten_hash(old_version.commit) if " " in old_version.name else old_version.name]
    arguments += [] if new_version.name == WORKING_TREE_NAME else [new_version.name]
    return " ".join(["archgen diff", *map(shlex.quote, arguments)])


def render_comparison_html(
    comparison: Comparison, old_version: ProjectVersion, new_version: ProjectVersion, options: OutputOptions
) -> bytes:
    """Write a comparison as one self-contained HTML page."""
    from archgen.emit.site import standalone_page
    from archgen.products.product_writing import draw_or_warn
    from archgen.views.changes.comparison_outline import write_comparison_outline
    from archgen.views.graphs import changes as pictures

    graphs = pictures.draw_changes(comparison)
    outline = write_comparison_outline(describe_versions(comparison, old_version, new_version, graphs))
    return standalone_page.write_standalone_page(outline, draw_or_warn(graphs, ("svg",), options) if graphs else {})


def render_comparison_svg(comparison: Comparison, options: OutputOptions) -> bytes:
    """Draw what changed among components, or among nodes where no component changed.

    Raise OutputError where there is nothing to draw.
    """
    from archgen.emit import file_tree
    from archgen.emit.picture_files import embed_fonts
    from archgen.emit.site import page_pictures as files
    from archgen.products.product_writing import draw_or_warn
    from archgen.views.graphs import changes as pictures

    graphs = pictures.draw_changes(comparison)
    if not graphs:
        msg = "nothing changed that a picture could show: no component, no connection and no node"
        raise file_tree.OutputError(msg, "`--format text` tells what changed")
    # The first graph is the functional one wherever there is one.
    picture: Picture | None = draw_or_warn(graphs[:1], ("svg",), options).get(graphs[0].id)
    if picture is None or picture.svg is None:
        raise file_tree.OutputError("the picture could not be drawn")
    # There is no page to link to: every link of the picture is dropped.
    return files.standalone_svg(picture.svg, lambda _anchor: None, embed_fonts([picture.svg]))


def compare_since(revision: str, path: Path | None, checked_project: CheckedProject) -> SiteChanges:
    """Compare a project with an earlier version of itself, for its site. `path` is the project, as for `check_project`.

    Raise `git.GitError` and `project.ProjectNotFoundError`.
    """
    return list_changes_since(read_version_before(revision, path, checked_project), checked_project)


def read_version_before(revision: str, path: Path | None, checked_project: CheckedProject) -> ProjectVersion:
    """Read an earlier version of a project; as it stood in the variants in which the project is shown, if it had them.

    Raise `git.GitError` and `project.ProjectNotFoundError`.
    """
    from archgen.pipeline import VersionCache, stand_in_variants
    from archgen.products import compared_versions

    new_version = ProjectVersion(WORKING_TREE_NAME, checked_project)
    old_version = compared_versions.read_earlier_version(revision, path, VersionCache(), new_version)
    steps = [name for name in checked_project.steps if name in old_version.checked_project.architecture.variants]
    if not steps:
        return old_version
    standing_project = stand_in_variants(old_version.checked_project, steps)
    return compared_versions.read_variant(old_version, standing_project, steps)


def list_changes_since(old_version: ProjectVersion, checked_project: CheckedProject) -> SiteChanges:
    """Compare a project with an earlier version of itself, for its site."""
    from archgen.products import compared_versions
    from archgen.views.changes.site_changes import SiteChanges
    from archgen.views.graphs import changes as pictures

    new_version = ProjectVersion(WORKING_TREE_NAME, checked_project)
    comparison = compared_versions.compare_named_versions(old_version, new_version)
    document = describe_versions(comparison, old_version, new_version, pictures.draw_changes(comparison))
    return SiteChanges(comparison, document, old_version.name)
