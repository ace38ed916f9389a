"""From two compared versions to a document: Markdown for a pull request, an HTML page, or a picture."""

from __future__ import annotations

import shlex

from archgen.compare import Comparison
from archgen.emit import file_tree
from archgen.emit.markdown import comparison_markdown
from archgen.emit.picture import Picture
from archgen.products.compared_versions import WORKING_TREE_NAME, ProjectVersion
from archgen.products.output_options import OutputOptions
from archgen.products.picture_drawing import draw_or_warn
from archgen.views.changes.comparison_document import ComparisonDocument, outline_comparison
from archgen.views.graphs import changes as pictures

_SHORT_HASH_LENGTH = 7
"""Digits of a commit's hash beside a name, as git prints them."""


def format_version_name(version: ProjectVersion) -> str:
    """Name a version as the user typed it, with its commit where that says more."""
    # A hash that begins with what the user typed says nothing new.
    name_suffices = not version.commit or version.commit.startswith(version.name)
    return version.name if name_suffices else f"{version.name} ({version.commit[:_SHORT_HASH_LENGTH]})"


def render_comparison_markdown(comparison: Comparison, old_version: ProjectVersion, new_version: ProjectVersion) -> str:
    """Write a comparison as the comment on a pull request."""
    names = comparison_markdown.SideNames(
        format_version_name(old_version), format_version_name(new_version), _terminal_command(old_version, new_version)
    )
    return comparison_markdown.write_comparison_markdown(
        comparison,
        names,
        (old_version.checked_project.structural_errors, new_version.checked_project.structural_errors),
    )


def _terminal_command(old_version: ProjectVersion, new_version: ProjectVersion) -> str:
    """Return the command that shows the same comparison in a terminal."""
    # A name with a blank is a description of ours ("where this branch left main"), no revision that git understands.
    arguments = [old_version.commit[:10] if " " in old_version.name else old_version.name]
    arguments += [] if new_version.name == WORKING_TREE_NAME else [new_version.name]
    return " ".join(["archgen diff", *map(shlex.quote, arguments)])


def render_comparison_html(
    comparison: Comparison, old_version: ProjectVersion, new_version: ProjectVersion, options: OutputOptions
) -> bytes:
    """Write a comparison as one self-contained HTML page."""
    from archgen.emit.site import standalone_page

    graphs = pictures.draw_changes(comparison)
    document = ComparisonDocument(
        comparison,
        format_version_name(old_version),
        format_version_name(new_version),
        (old_version.checked_project.structural_errors, new_version.checked_project.structural_errors),
        graphs,
    )
    return standalone_page.write_standalone_page(
        outline_comparison(document), draw_or_warn(graphs, ("svg",), options) if graphs else {}
    )


def render_comparison_svg(comparison: Comparison, options: OutputOptions) -> bytes:
    """Draw what changed among components, or among nodes where no component changed.

    Raise OutputError where there is nothing to draw.
    """
    graphs = pictures.draw_changes(comparison)
    if not graphs:
        msg = "nothing changed that a picture could show: no component, no connection and no node"
        raise file_tree.OutputError(msg, "`--format text` tells what changed")
    # The first graph is the functional one wherever there is one.
    picture: Picture | None = draw_or_warn(graphs[:1], ("svg",), options).get(graphs[0].id)
    if picture is None or picture.svg is None:
        msg = "the picture could not be drawn"
        raise file_tree.OutputError(msg)
    from archgen.emit.site import page_pictures as files

    # There is no page to link to: every link of the picture is dropped.
    return files.standalone_svg(picture.svg, lambda _anchor: None)
