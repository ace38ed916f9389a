"""The products of a build, by name, and how each is made: `build` walks all of them, the other verbs one."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING

from archgen.emit import file_tree
from archgen.products import report_cache
from archgen.products.product_inputs import FinishProduct, MadeProduct, Product, ProductInputs
from archgen.regular_files import read_named_file

if TYPE_CHECKING:
    from archgen.emit.picture import Picture

MAX_TEMPLATE_BYTES = 200_000_000
"""The largest template that is read: as much as one may unpack to."""


class _RecordingReader:
    """Reads files and remembers which were asked for; each is created for one call of one writer."""

    def __init__(self, read_file: Callable[[str], bytes | None]) -> None:
        self._read_file = read_file
        self.asked_files: dict[str, bytes | None] = {}

    def read(self, path: str) -> bytes | None:
        """Read a file; None if there is none."""
        self.asked_files[path] = self._read_file(path)
        return self.asked_files[path]


def _start_report(inputs: ProductInputs) -> FinishProduct:
    outline = inputs.printed_report
    template = read_named_file(inputs.template, MAX_TEMPLATE_BYTES) if inputs.template else None

    # Called on a miss only. The cache hands in a reader that records which chapter pictures the writer asks for.
    def write_anew(
        pictures: Mapping[str, Picture], chapter_files: report_cache.ChapterFileReader
    ) -> report_cache.ReportWithWarnings:
        """Write the report, with a broken template as the user's mistake."""
        from archgen.emit import docx

        try:
            return docx.write(outline, pictures, template=template, chapter_files=chapter_files)
        except docx.TemplateError as error:
            raise file_tree.OutputError(str(error)) from None

    def finish(pictures: Mapping[str, Picture]) -> MadeProduct:
        reader = _RecordingReader(inputs.checked_project.chapters.read_picture)
        # Warnings are cached with the report: a report from the cache must warn as the first one did.
        document, warnings = report_cache.get_or_write_report(
            report_cache.cache_folder(),
            outline,
            pictures,
            template=template,
            chapter_files=reader.read,
            write_report=lambda chapter_files: write_anew(pictures, chapter_files),
        )
        return MadeProduct(document, warnings, reader.asked_files)

    return finish


def _start_site(inputs: ProductInputs) -> FinishProduct:
    from archgen.cache.layout_memory import LayoutMemory
    from archgen.cache.program_stamp import stamp_writers
    from archgen.emit import site
    from archgen.views.explorer import make_explorer_map
    from archgen.views.pages import report_outline
    from archgen.views.search import make_search_entries

    page_list = inputs.pages
    search_entries = make_search_entries(inputs.views.lookup, page_list)
    explorer_map = make_explorer_map(inputs.views.lookup, LayoutMemory(report_cache.cache_folder(), stamp_writers()))

    def finish(pictures: Mapping[str, Picture]) -> MadeProduct:
        reader = _RecordingReader(inputs.checked_project.chapters.read_picture)
        files = site.build_site(
            page_list,
            {name: picture for name, picture in pictures.items() if name in inputs.site_drawings},
            title=inputs.checked_project.architecture.project.title,
            revision=inputs.views.edition.revision,
            notices=report_outline.make_notices(inputs.views.lookup, inputs.views.edition),
            chapter_files=reader.read,
            search_entries=search_entries,
            explorer_map=explorer_map,
            report=inputs.report_path,
        )
        return MadeProduct(files, asked_files=reader.asked_files)

    return finish


def make_diagrams_product(formats: Sequence[str], name_patterns: Sequence[str] = ()) -> Product:
    """Make the product of pictures in these formats (svg, png, pdf, dot), by patterns of their ids (none: all)."""

    def start(_inputs: ProductInputs) -> FinishProduct:
        from archgen.emit import picture_files

        return lambda pictures: MadeProduct(picture_files.build_picture_tree(pictures, formats))

    return Product("diagrams", "diagrams", start, tuple(formats), tuple(name_patterns) or ("*",))


def _start_slides(inputs: ProductInputs) -> FinishProduct:
    from archgen.emit.pptx import PythonPptxError, write_slides
    from archgen.emit.template_package import TemplateError

    template = read_named_file(inputs.template, MAX_TEMPLATE_BYTES) if inputs.template else None

    def finish(pictures: Mapping[str, Picture]) -> MadeProduct:
        try:
            return MadeProduct(write_slides(inputs.slide_deck, pictures, template))
        except (PythonPptxError, TemplateError) as error:
            raise file_tree.OutputError(str(error)) from None

    return finish


def _start_packed(inputs: ProductInputs) -> FinishProduct:
    from archgen.checking.checked_packing import pack_checked_project
    from archgen.emit.own_file_marks import PACKED_HEADER
    from archgen.syntax import yaml_writer

    packed_project = pack_checked_project(inputs.checked_project)
    content = (PACKED_HEADER + yaml_writer.write_yaml(packed_project.data, packed_project.comments)).encode()
    chapters = inputs.checked_project.chapters
    asked_files = {path: chapters.read_picture(path) for path in chapters.list_picture_paths()}
    return lambda _pictures: MadeProduct(content, asked_files=asked_files)


# A PNG for programs that know no SVG; an SVG with text as outlines, since the reader's Word may lack the font.
REPORT = Product(
    "report",
    "report.docx",
    _start_report,
    ("png", "svg_outlines"),
    list_drawings=lambda inputs: inputs.report_drawings,
)
SITE = Product(
    "site", "site", _start_site, ("svg",), entry_file="index.html", list_drawings=lambda inputs: inputs.site_drawings
)
SLIDES = Product(
    "slides",
    "slides.pptx",
    _start_slides,
    ("png", "svg_outlines"),
    list_drawings=lambda inputs: inputs.slide_drawings,
)
# No PNG: the report has its own, and who wants files asks `archgen diagram` for them.
DIAGRAMS = make_diagrams_product(("svg",))
PACKED = Product("packed", "packed.yaml", _start_packed)

PRODUCTS: Mapping[str, Product] = {product.name: product for product in (REPORT, SITE, DIAGRAMS, PACKED)}
"""What `archgen build` makes, in the order in which it is written."""
