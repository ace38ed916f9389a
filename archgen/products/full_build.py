"""Everything at once: report, site, diagrams, packed file and further backends, below one folder.

What takes long runs side by side, and what nothing changed of is not made again.
"""

from __future__ import annotations

import contextlib
import json
import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from archgen.cache.file_store import FileStore, digest_bytes, digest_text
from archgen.cache.program_stamp import stamp_program
from archgen.emit import file_tree
from archgen.emit.file_tree import OutputError
from archgen.frozen import replace
from archgen.pipeline import CheckedProject
from archgen.products import project_views, report_cache
from archgen.products.product_inputs import Product, ProductInputs
from archgen.products.product_table import MAX_TEMPLATE_BYTES, PRODUCTS, REPORT, SITE
from archgen.products.product_writing import StartedProducts, start_products, write_started
from archgen.products.seen_robots import read_seen_robots
from archgen.regular_files import read_named_file

if TYPE_CHECKING:
    from archgen.products.trusted_backends import TrustedRevision


def choose_products(
    checked_project: CheckedProject,
    only_names: Sequence[str] = (),
    backend_names: Sequence[str] = (),
    trusted_revision: TrustedRevision | None = None,
) -> tuple[Product, ...]:
    """Return what a build makes, in its order: all products or only the named ones, then the backends.

    `only_names` may name backends, too. Raise OutputError for a name that is neither, and for a backend that may not
    run.
    """
    products = [product for name, product in PRODUCTS.items() if name in only_names or not only_names]
    named_backends = [name for name in only_names if name not in PRODUCTS]
    if not named_backends and not backend_names:
        return tuple(products)
    # Imported here: most builds make no output of a backend.
    from archgen.products.backend_choice import choose_backends
    from archgen.products.backend_products import make_backend_product

    backends = (
        *choose_backends(checked_project, named_backends, "documents", trusted_revision, other_outputs=PRODUCTS),
        *choose_backends(checked_project, backend_names, "documents", trusted_revision),
    )
    # The same backend may be named in both ways.
    return (*products, *(make_backend_product(backend) for backend in {each.id: each for each in backends}.values()))


def build_outputs(
    inputs: ProductInputs,
    products: Sequence[Product],
    target: Path,
    announce: Callable[[Path], None] = lambda _path: None,
) -> None:
    """Write products below a folder, and announce the path of each as soon as it is there.

    A product that is there already, from the same inputs, is not made again. Where one cannot be made or written, all others
    are, and OutputError is raised in the end.
    """
    # Settled once: git is asked a single time, and the stamps depend on the revision that is printed.
    revision = project_views.choose_revision(inputs.checked_project, inputs.options)
    shows_components = any(product is not SITE and product.picture_formats is not None for product in products)
    inputs = replace(
        inputs,
        options=replace(inputs.options, revision=revision),
        undrawn_kinds=frozenset() if shows_components else inputs.site_undrawn_kinds,
        report_path=f"../{REPORT.part}" if REPORT in products or (target / REPORT.part).is_file() else "",
    )
    stamp_keys = _make_stamp_keys(inputs, products)
    fresh_names = {
        product.name
        for product in products
        if product.name in stamp_keys
        and is_fresh(
            report_cache.cache_folder(),
            stamp_keys[product.name],
            target / product.part,
            inputs.checked_project.chapters.read_picture,
        )
    }
    started_products = start_products(inputs, [product for product in products if product.name not in fresh_names])
    # From here on files appear: all views are made and all pictures are drawn.
    failures: list[OutputError] = []
    for product in products:
        place = target / product.part
        try:
            is_there = (
                place.exists()
                if product.name in fresh_names
                else _write_and_stamp(inputs, started_products, product, place, stamp_keys.get(product.name))
            )
        except OutputError as error:
            failures.append(error)
            continue
        # Where nothing can be drawn, there are no diagrams.
        if is_there:
            announce(place / product.entry_file)
    if failures:
        raise OutputError("; ".join(dict.fromkeys(error.message for error in failures)), failures[0].help)


def _write_and_stamp(
    inputs: ProductInputs, started_products: StartedProducts, product: Product, place: Path, stamp_key: str | None
) -> bool:
    """Write a product, and store its stamp where it has a key. Return whether there was anything to write."""
    made_product = write_started(inputs, started_products, product, place)
    drawing_warnings = started_products.drawn.warnings if product.picture_formats is not None else ()
    # A product with warnings is made again next time, so that its warnings are repeated, too.
    if stamp_key and not made_product.warnings and not drawing_warnings:
        store_stamp(report_cache.cache_folder(), stamp_key, place, made_product.asked_files)
    return not made_product.is_empty


def _make_stamp_keys(inputs: ProductInputs, products: Sequence[Product]) -> Mapping[str, str]:
    """Return the stamp's key of each product that the inputs decide, by its name."""
    if not any(product.follows_inputs for product in products):
        return {}
    shared_key = make_stamp_key(_list_inputs(inputs))
    template = read_named_file(inputs.template, MAX_TEMPLATE_BYTES) if inputs.template else None
    own_inputs = {REPORT.name: template, SITE.name: inputs.report_path}
    return {
        product.name: make_stamp_key((shared_key, product.name, own_inputs.get(product.name)))
        for product in products
        if product.follows_inputs
    }


def _list_inputs(inputs: ProductInputs) -> Iterator[object]:
    """Yield all that decides the outputs' bytes, except this program, the template and the pictures of chapters.

    The program is part of the stamp's key; chapter pictures are known only after the writers asked for them.
    """
    checked_project, options = inputs.checked_project, inputs.options
    project, sources, chapters = checked_project.architecture.project, checked_project.sources, checked_project.chapters
    yield project.id, project.title, options.selector_text, options.level, options.revision, options.component_pictures
    # `sources` has the text of every file that was read, interface definitions included.
    yield (
        checked_project.yaml_files,
        checked_project.input_files,
        [(file, sources.text_of(file)) for file in sources.file_names()],
    )
    yield chapters.order, [(name, chapter.text) for name, chapter in chapters.texts.items()], checked_project.findings
    yield project_views.identify_history(checked_project, options)
    yield read_seen_robots(checked_project)


_MAX_STAMPS = 256
"""Stamps that are kept, four for each build; each takes some hundred bytes."""


def make_stamp_key(build_inputs: Iterable[object]) -> str:
    """Return the name of a stamp: a digest of this program and of values whose `repr` is complete."""
    return digest_text("\n".join([stamp_program(), *(repr(part) for part in build_inputs)]))


def is_fresh(folder: Path | None, stamp_key: str, place: Path, read_file: Callable[[str], bytes | None]) -> bool:
    """Whether a product stands at its place as it was written from the same inputs.

    `read_file` returns the files that the writer asked for (pictures of chapters), which decide the product as well.
    """
    try:
        stamp = json.loads(_stamp_files(folder).load(stamp_key) or b"{}")
        asked_digests, product_digest = dict(stamp["asked"]), stamp["made"]
        # The few inputs first: the product's digest reads every file of a site.
        return all(
            digest_bytes(read_file(path)) == stored_digest for path, stored_digest in asked_digests.items()
        ) and bool(product_digest == _digest_product(place))
    except (OSError, ValueError, KeyError, TypeError, AttributeError):
        return False


def store_stamp(folder: Path | None, stamp_key: str, place: Path, asked_files: Mapping[str, bytes | None]) -> None:
    """Store the stamp of a product that was written just now; `asked_files` are those that its writer asked for."""
    if folder is None:
        return
    # A full or read-only disk, or somebody who changes files meanwhile, costs only the time that this would have saved.
    with contextlib.suppress(OSError, ValueError):
        stamp = {
            "made": _digest_product(place, just_written=True),
            "asked": {path: digest_bytes(data) for path, data in asked_files.items()},
        }
        _stamp_files(folder).store(stamp_key, json.dumps(stamp).encode())


def _stamp_files(folder: Path | None) -> FileStore:
    return FileStore(folder, ".stamp", _MAX_STAMPS)


def _digest_product(place: Path, *, just_written: bool = False) -> str:
    """Return a digest of a file, or of the manifest of a folder; `absent` where nothing is.

    `just_written` is for folders that were written just now: their files are not read again. Raise ValueError for what
    archgen has not written so.
    """
    if not os.path.lexists(place):
        return "absent"
    digest = None
    if place.is_dir() and not place.is_symlink():
        digest = file_tree.digest_manifest(place, just_written=just_written)
    elif not place.is_symlink():
        digest = file_tree.digest_named_file(str(place), place.stat().st_size)
    if digest is None:
        raise ValueError(f"{place} is not as archgen wrote it")
    return digest
