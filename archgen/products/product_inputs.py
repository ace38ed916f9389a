"""What products are made from, and what a product is. Nothing here is written yet."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

from archgen.emit.file_tree import FileTree
from archgen.emit.picture import Picture
from archgen.frozen import dataclass, field, replace
from archgen.model.document_chapters import GENERATED_CHAPTERS
from archgen.pipeline import CheckedProject
from archgen.products import project_views
from archgen.products.output_options import OutputOptions
from archgen.products.project_views import ProjectViews

if TYPE_CHECKING:
    from archgen.views.lookup import Lookup
    from archgen.views.pages.report_outline import DocumentEdition, RosPlace
    from archgen.views.picture_shapes import Drawing, GraphKind
    from archgen.views.shapes import Outline, Page


# Without slots: `cached_property` stores its values in the object's dictionary.
@dataclass(frozen=True)
class ProductInputs:
    """What products are made from. Views are made when the first product asks for them, once for all."""

    checked_project: CheckedProject
    options: OutputOptions
    template: Path | None = None
    """The user's template of the Word report, or of the slides."""
    report_path: str = ""
    """Where the report is from the site's folder, if there is one."""
    undrawn_kinds: frozenset[GraphKind] = frozenset()
    """The kinds of pictures that no product shows."""
    is_report_alone: bool = False
    """Whether there is no other product: it shows neither the runs in which chains are late nor marks of what changed."""

    @property
    def site_undrawn_kinds(self) -> frozenset[GraphKind]:
        """The kinds of pictures that the site leaves to its map, since there are too many of them."""
        from archgen.views import drawing_set

        components = self._list_shown_components()
        groups = {name.partition(".")[0] for name in components}
        return drawing_set.list_undrawn_kinds(len(components), len(groups), wish=self.options.component_pictures)

    def _list_shown_components(self) -> Collection[str]:
        selection = self.options.selection
        return self.checked_project.architecture.components if selection is None else selection.components

    @cached_property
    def views(self) -> ProjectViews:
        """The look-ups and drawings."""
        return project_views.make_views(
            self.checked_project,
            self.options,
            undrawn_kinds=self.undrawn_kinds,
            is_report_alone=self.is_report_alone,
        )

    @cached_property
    def timed_lookup(self) -> Lookup:
        """The look-ups with the timing analysis, without drawings."""
        from archgen.views.lookup import add_timing
        from archgen.views.timing.timing_lookup import add_late_runs, complete_with_chains

        analysis, architecture = self.checked_project.analysis, self.checked_project.architecture
        lookup = project_views.make_scoped_lookup(self.checked_project, self.options)
        return add_timing(lookup, add_late_runs(complete_with_chains(analysis, architecture)))

    @cached_property
    def site_drawings(self) -> Mapping[str, Drawing]:
        """The drawings that the site shows, by id."""
        from archgen.views.picture_shapes import Graph

        undrawn_kinds = self.site_undrawn_kinds
        return {
            name: each
            for name, each in self.views.drawings.items()
            if not (isinstance(each, Graph) and each.kind in undrawn_kinds)
        }

    @cached_property
    def outline(self) -> Outline:
        """The architecture as one document, for templates."""
        from archgen.views.pages import report_outline

        return report_outline.make_report(self.views.lookup, self.views.edition)

    @cached_property
    def printed_report(self) -> Outline:
        """The contents of the Word report."""
        # Here and below: nothing but the report reads these, and a site has enough to load.
        from archgen.views.report.data_sheets import make_data_sheets
        from archgen.views.report.deliverable import make_deliverable
        from archgen.views.report.printed_report import make_printed_report

        makers = {"data-sheets": make_data_sheets, "deliverable": make_deliverable}
        return makers.get(self.options.document, make_printed_report)(self.views.lookup, self._report_edition)

    @property
    def _report_edition(self) -> DocumentEdition:
        """What the report contains: at the level that is asked for here, else in the project."""
        level = self.options.level or self.views.edition.settings.level
        ros_place: RosPlace = "inline" if level == "implementation" else "annex"
        document = self.options.document
        return replace(self.views.edition, level=level or "implementation", ros_place=ros_place, document=document)

    @cached_property
    def tabled_report(self) -> Outline:
        """The architecture as one document at the report's level, each table as it is on the site."""
        from archgen.views.pages import report_outline

        edition = self._report_edition
        # All lists, whatever chapters the project chose for its readers.
        others = (name for name in GENERATED_CHAPTERS if name not in edition.chapter_names)
        names = (*edition.chapter_names, *others)
        edition = replace(edition, document="workbook", chapter_names=names)
        return report_outline.make_report(self.views.lookup, edition)

    @cached_property
    def report_drawings(self) -> Mapping[str, Drawing]:
        """The pictures of the Word report by their own ids: those that it shows."""
        from archgen.views.report.report_drawings import make_report_drawings

        shown_ids = _list_shown_pictures(self.printed_report)
        shows_ros = self._report_edition.level == "implementation"
        drawings = make_report_drawings(self.views.lookup, self.views.drawings, shows_ros=shows_ros)
        return {drawing.id: drawing for drawing in drawings.values() if drawing.id in shown_ids}

    @cached_property
    def slide_deck(self) -> Outline:
        """The contents of the slides."""
        from archgen.views.report.slide_deck import make_slide_deck

        return make_slide_deck(self.views.lookup, replace(self.views.edition, drawings=self._slide_choice))

    @cached_property
    def _slide_choice(self) -> Mapping[str, Drawing]:
        """All pictures, that of the hosts as slides show it."""
        from archgen.views.graphs.host_rack import draw_slide_rack

        drawings = self.views.drawings
        return {**drawings, "hosts": draw_slide_rack(self.views.lookup)} if "hosts" in drawings else drawings

    @cached_property
    def slide_drawings(self) -> Mapping[str, Drawing]:
        """The pictures that the slides show, by id."""
        shown_ids = _list_shown_pictures(self.slide_deck)
        return {each.id: each for each in self._slide_choice.values() if each.id in shown_ids}

    @cached_property
    def pages(self) -> tuple[Page, ...]:
        """The site's pages."""
        from archgen.views.pages import site_pages

        edition = replace(self.views.edition, drawings=self.site_drawings, undrawn_kinds=self.site_undrawn_kinds)
        return tuple(site_pages.make_pages(self.views.lookup, edition))


def _list_shown_pictures(outline: Outline) -> frozenset[str]:
    from archgen.views.report.printed_report import walk_sections
    from archgen.views.shapes import Figure

    sections = walk_sections((*outline.front_sections, *outline.sections))
    return frozenset(block.graph for section in sections for block in section.blocks if isinstance(block, Figure))


@dataclass(frozen=True, slots=True)
class MadeProduct:
    """A product in memory: a file's bytes or a folder's files, with the warnings of its writer.

    `asked_files` are the files that the writer asked for beyond the inputs of every build (pictures of chapters), None
    for one that is absent.
    """

    content: bytes | FileTree
    warnings: tuple[str, ...] = ()
    asked_files: Mapping[str, bytes | None] = field(default_factory=dict)

    @property
    def is_empty(self) -> bool:
        """Whether it is a folder without a file."""
        return isinstance(self.content, FileTree) and not self.content.files


FinishProduct = Callable[[Mapping[str, Picture]], MadeProduct]
"""Makes a product from the drawn pictures, by id."""


@dataclass(frozen=True, slots=True)
class Product:
    """Something that a build makes.

    `start` does all that needs no picture, while others are drawing, and returns the function that does the rest.
    """

    name: str
    part: str
    """Its file or folder below the output folder."""
    start: Callable[[ProductInputs], FinishProduct]
    picture_formats: tuple[str, ...] | None = None
    """The formats of the pictures that it shows; None if it shows none."""
    picture_patterns: tuple[str, ...] = ("*",)
    """The ids of the pictures that it shows."""
    list_drawings: Callable[[ProductInputs], Mapping[str, Drawing]] = lambda inputs: inputs.views.drawings
    """The drawings among which these are."""
    entry_file: str = ""
    """The file of its folder to open first."""
    follows_inputs: bool = True
    """Whether the inputs of a build decide its bytes, so that it need not be made again while they stay the same."""
