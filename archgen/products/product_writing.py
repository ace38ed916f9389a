"""From products to files, for every verb in the same steps: make the views, draw, finish each product, write it."""

from __future__ import annotations

import fnmatch
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from archgen.emit import file_tree
from archgen.emit.picture import Picture
from archgen.frozen import dataclass, field
from archgen.pipeline import CheckedProject
from archgen.products import report_cache
from archgen.products.output_options import DrawingProgress, OutputOptions, refuse_leaving_links
from archgen.products.product_inputs import FinishProduct, MadeProduct, Product, ProductInputs
from archgen.regular_files import holds_bytes
from archgen.views.picture_shapes import Drawing

if TYPE_CHECKING:
    from archgen.emit.graphviz.worker_pool import DrawingWorker


@dataclass(frozen=True, slots=True)
class DrawnPictures:
    """Pictures by id, and what could not be drawn as asked."""

    pictures: Mapping[str, Picture] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()


def _draw_started_pictures(
    drawings: Sequence[Drawing],
    formats: Sequence[str] | Mapping[str, Sequence[str]],
    progress: DrawingProgress | None = None,
    workers: Sequence[DrawingWorker] = (),
) -> DrawnPictures:
    """Draw graphs and charts in formats for all or by their ids, on idle `workers` where there are some; links lead to
    `#` and an element's anchor.

    Where the machine lacks the drawing libraries there are no pictures, but a warning.
    """
    from archgen.emit import graphviz

    try:
        pictures = graphviz.draw_pictures(
            drawings,
            formats,
            resolve_link=lambda ref: f"#{ref}",
            cache=report_cache.cache_folder(),
            progress=progress,
            ready_workers=workers,
        )
    except graphviz.MissingGraphviz as error:
        return DrawnPictures(warnings=(str(error),))
    return DrawnPictures(
        pictures, tuple(f"{picture.id}: {picture.warning}" for picture in pictures.values() if picture.warning)
    )


def draw_or_warn(drawings: Sequence[Drawing], formats: Sequence[str], options: OutputOptions) -> Mapping[str, Picture]:
    """Draw graphs and charts, and pass on the warnings."""
    drawn = _draw_started_pictures(drawings, formats, options.progress)
    for warning in drawn.warnings:
        options.warn(warning)
    return drawn.pictures


_MAX_NAMED_PICTURES = 8
"""At most this many pictures are named in a message."""


@dataclass(frozen=True, slots=True)
class StartedProducts:
    """Products of which all is made that needs no picture, and the drawn pictures."""

    finishers: Mapping[str, FinishProduct]
    """By the product's name."""
    drawn: DrawnPictures


def start_products(inputs: ProductInputs, products: Sequence[Product]) -> StartedProducts:
    """Draw all pictures that products show, and meanwhile make what needs none. Nothing is written.

    Raise OutputError where patterns match no picture.
    """
    shown_products = [product for product in products if product.picture_formats is not None]
    if not shown_products:
        return StartedProducts({product.name: product.start(inputs) for product in products}, DrawnPictures())
    # Imported here: where nothing is drawn, it is half of what would be loaded of Python.
    from concurrent.futures import ThreadPoolExecutor

    from archgen.emit import graphviz

    # Workers start before the views are made: both take long.
    with graphviz.start_early_workers(report_cache.cache_folder()) as workers, ThreadPoolExecutor(1) as executor:
        drawings, formats = _choose_drawings(inputs, shown_products)
        # Other processes draw, and the thread waits for them.
        drawing_future = executor.submit(_draw_started_pictures, drawings, formats, inputs.options.progress, workers)
        finishers = {product.name: product.start(inputs) for product in products}
        drawn = drawing_future.result()
    for warning in drawn.warnings:
        inputs.options.warn(warning)
    return StartedProducts(finishers, drawn)


def _choose_drawings(
    inputs: ProductInputs, products: Sequence[Product]
) -> tuple[tuple[Drawing, ...], Mapping[str, Sequence[str]]]:
    """Return the drawings that any of the products shows, and by their ids the formats in which they are shown.

    Most are shown by one product only. To draw a format that nobody asks for takes longer than the layout.
    """
    drawings: dict[str, Drawing] = {}
    formats: dict[str, list[str]] = {}
    for product in products:
        shown_drawings = _list_shown(inputs, product)
        drawings |= shown_drawings
        for name in shown_drawings:
            formats.setdefault(name, []).extend(product.picture_formats or ())
    patterns = dict.fromkeys(pattern for product in products for pattern in product.picture_patterns)
    if not drawings and "*" not in patterns:
        msg = f"no picture is called {' or '.join(patterns)}"
        raise file_tree.OutputError(msg, _name_pictures(inputs.views.drawings))
    return tuple(drawings.values()), formats


def _list_shown(inputs: ProductInputs, product: Product) -> dict[str, Drawing]:
    return {
        name: drawing
        for name, drawing in product.list_drawings(inputs).items()
        if any(fnmatch.fnmatchcase(name, pattern) for pattern in product.picture_patterns)
    }


def _name_pictures(names: Iterable[str]) -> str:
    """Name the first pictures of a project, for a message."""
    all_names = list(names)
    if not all_names:
        return "there is nothing to draw yet"
    further = ", ..." if len(all_names) > _MAX_NAMED_PICTURES else ""
    return f"there are {', '.join(all_names[:_MAX_NAMED_PICTURES])}{further}"


def write_started(
    inputs: ProductInputs, started_products: StartedProducts, product: Product, target: Path
) -> MadeProduct:
    """Finish a product and write it: completely, or not at all. Return it as it was written."""
    refuse_leaving_links(inputs.checked_project, target)
    made_product = make_content(inputs, started_products, product)
    if isinstance(made_product.content, bytes):
        write_product_file(inputs.checked_project, target, made_product.content)
    else:
        file_tree.write_tree(made_product.content, target)
    return made_product


def make_content(inputs: ProductInputs, started_products: StartedProducts, product: Product) -> MadeProduct:
    """Finish a product in memory, and pass on its warnings."""
    # One product's pictures are none of another's: the report draws some anew, under ids of their own.
    shown_names = _list_shown(inputs, product) if product.picture_formats is not None else {}
    pictures = {name: each for name, each in started_products.drawn.pictures.items() if name in shown_names}
    made_product = started_products.finishers[product.name](pictures)
    for warning in made_product.warnings:
        inputs.options.warn(warning)
    return made_product


def write_product(inputs: ProductInputs, product: Product, target: Path) -> MadeProduct:
    """Make and write a single product."""
    return write_started(inputs, start_products(inputs, (product,)), product, target)


def write_product_file(checked_project: CheckedProject, target: Path, content: bytes) -> None:
    """Write a single file, unless the project reads another one in its place."""
    refuse_leaving_links(checked_project, target)
    if target.is_file() and _is_read_by_project(checked_project, target) and not holds_bytes(target, content):
        msg = f"{target} is a file of the project itself"
        raise file_tree.OutputError(msg, "give the name of another file with `-o`")
    file_tree.write_file(target, content)


def _is_read_by_project(checked_project: CheckedProject, file: Path) -> bool:
    """Whether a file is an input of the project, a picture of its chapters, or part of a backend or pass of its own."""
    root = checked_project.root
    inputs = (*checked_project.input_files, *checked_project.chapters.list_picture_paths())
    own_folders = [(root / name).resolve() for name in ("backends", "passes")]
    return any(_is_same_file(file, root / name) for name in inputs) or any(
        map(file.resolve().is_relative_to, own_folders)
    )


def _is_same_file(first: Path, second: Path) -> bool:
    """Whether two paths lead to one file, by whatever links."""
    try:
        return first.samefile(second)
    except OSError:  # one of them is gone, or cannot be looked at
        return False
