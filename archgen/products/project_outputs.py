"""Single outputs of a checked project, one function for each verb that writes one."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import get_args

from archgen.emit import file_tree
from archgen.frozen import replace
from archgen.pipeline import CheckedProject
from archgen.products.output_options import OutputOptions
from archgen.products.product_inputs import ProductInputs
from archgen.products.product_table import PACKED, REPORT, SITE, SLIDES, make_diagrams_product
from archgen.products.product_writing import (
    make_content,
    start_products,
    write_product,
    write_product_file,
    write_started,
)
from archgen.products.project_views import make_scoped_lookup
from archgen.views.picture_shapes import GraphKind


def write_report(
    checked_project: CheckedProject, options: OutputOptions, target: Path, template: Path | None = None
) -> None:
    """Write the Word report. Raise OSError, or OutputError for what the user can mend."""
    write_product(_take_report_inputs(checked_project, options, template), REPORT, target)


def _take_report_inputs(
    checked_project: CheckedProject, options: OutputOptions, template: Path | None
) -> ProductInputs:
    """Return the inputs of a report alone, without pictures that it does not show: of 1,000 components they take minutes."""
    inputs = ProductInputs(checked_project, options, template)
    if options.document == "full":
        return inputs
    shown = {"component"} if options.document == "data-sheets" else {"overview", "hosts", "frames"}
    return replace(inputs, undrawn_kinds=frozenset(get_args(GraphKind)) - shown, is_report_alone=True)


def write_report_pdf(
    checked_project: CheckedProject, options: OutputOptions, target: Path, template: Path | None = None
) -> None:
    """Write the Word report as PDF, by LibreOffice. Raise OSError, or OutputError for what the user can mend."""
    from archgen.emit.pdf_conversion import LibreOfficeError, convert_document, find_libreoffice

    try:
        # Before the report is written: that takes long.
        find_libreoffice()
        inputs = _take_report_inputs(checked_project, options, template)
        started_products = start_products(inputs, (REPORT,))
        document = make_content(inputs, started_products, REPORT)
        data = document.content if isinstance(document.content, bytes) else b""
        content = convert_document(data, inputs.views.edition.date)
    except LibreOfficeError as error:
        raise file_tree.OutputError(str(error)) from None
    write_product_file(checked_project, target, content)


def write_report_workbook(checked_project: CheckedProject, options: OutputOptions, target: Path) -> None:
    """Write all tables of the report as an Excel workbook. Raise OSError, or OutputError for what the user can mend."""
    from archgen.emit.xlsx import XlsxWriterError, write_workbook

    try:
        content = write_workbook(ProductInputs(checked_project, options).tabled_report)
    except XlsxWriterError as error:
        raise file_tree.OutputError(str(error)) from None
    write_product_file(checked_project, target, content)


def write_slides(
    checked_project: CheckedProject, options: OutputOptions, target: Path, template: Path | None = None
) -> None:
    """Write slides for a meeting. Raise OSError, or OutputError for what the user can mend."""
    undrawn = frozenset(get_args(GraphKind)) - {"overview", "hosts"}
    inputs = ProductInputs(checked_project, options, template, undrawn_kinds=undrawn, is_report_alone=True)
    write_product(inputs, SLIDES, target)


def write_site(checked_project: CheckedProject, options: OutputOptions, target: Path) -> None:
    """Write the static site into a folder."""
    inputs = ProductInputs(checked_project, options)
    write_product(replace(inputs, undrawn_kinds=inputs.site_undrawn_kinds), SITE, target)


def write_diagrams(
    checked_project: CheckedProject,
    options: OutputOptions,
    target: Path,
    formats: Sequence[str],
    name_patterns: Sequence[str] = (),
) -> int:
    """Write pictures in the given formats (svg, png, pdf, dot) and return how many there are.

    `name_patterns` select pictures by id. Raise OutputError where none matches, or where no picture can be drawn.
    """
    inputs = ProductInputs(checked_project, options)
    product = make_diagrams_product(formats, name_patterns)
    started_products = start_products(inputs, (product,))
    # A build without the drawing libraries only warns; here the pictures are all that was asked for.
    if inputs.views.drawings and not started_products.drawn.pictures:
        raise file_tree.OutputError("no picture could be drawn, nothing was written")
    write_started(inputs, started_products, product, target)
    return len(started_products.drawn.pictures)


def write_packed(checked_project: CheckedProject, target: Path) -> None:
    """Write the packed project."""
    write_product(ProductInputs(checked_project, OutputOptions()), PACKED, target)


def render_packed(checked_project: CheckedProject) -> bytes:
    """Return the packed project."""
    inputs = ProductInputs(checked_project, OutputOptions())
    content = make_content(inputs, start_products(inputs, (PACKED,)), PACKED).content
    return content if isinstance(content, bytes) else b""


def render_resolved(checked_project: CheckedProject, options: OutputOptions) -> bytes:
    """Return the resolved model as YAML."""
    from archgen.syntax import yaml_writer
    from archgen.views.records import resolved_record

    data = resolved_record.make_record(make_scoped_lookup(checked_project, options))
    return yaml_writer.write_yaml(data).encode()


def render_exported(checked_project: CheckedProject, options: OutputOptions, backend_name: str) -> bytes:
    """Return the single file of a text backend. Raise OutputError where none of this name makes
    one, or where its template fails.
    """
    from archgen.products.backend_choice import choose_backends
    from archgen.products.backend_products import render_single_file

    (backend,) = choose_backends(checked_project, (backend_name,), "file", options.trusted_revision)
    return render_single_file(ProductInputs(checked_project, options), backend)
