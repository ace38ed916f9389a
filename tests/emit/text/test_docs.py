"""The manual's example is a backend that works, and its tables name what there is."""

from __future__ import annotations

import json
import re
from pathlib import Path
from typing import get_args

from archgen.emit import text
from archgen.emit.backend_manifests import find_backends
from archgen.emit.text.template_filters import TEMPLATE_FILTERS
from archgen.views.generation import DOCUMENT_VIEWS, list_view_names
from archgen.views.picture_shapes import GraphKind
from archgen.views.shapes import Page, Section

ROOT = Path(__file__).resolve().parents[3]
DOCS = ROOT / "docs" / "backends.md"


def test_the_example_works(tmp_path: Path) -> None:
    manifest, template = re.findall(r"```(?:yaml|jinja)\n(.*?)```", DOCS.read_text(), re.DOTALL)
    folder = tmp_path / "backends" / "node_list"
    (folder / "templates").mkdir(parents=True)
    (folder / "backend.yaml").write_text(manifest)
    (folder / "templates" / "nodes.md.j2").write_text(template)
    (folder / "templates" / "node.md.j2").write_text("# {{ item.title|markdown }}\n")
    backends, diagnostics = find_backends(tmp_path)
    assert diagnostics == ()
    page = Page("nodes/cam_1.html", "node:cam_1", "cam_1", "nodes", Section("node:cam_1", "cam_1", ()), lead="Driver")
    tree, diagnostics = text.render_backend(backends["node_list"], {"pages": (page,)})
    assert diagnostics == ()
    assert tree is not None
    assert {path: data.decode() for path, data in tree.files.items()} == {
        "nodes.md": "# Nodes\n\n- [cam\\_1](nodes/cam_1.md): Driver\n",
        "nodes/cam_1.md": "# cam\\_1\n",
    }


def _first_column(heading: str) -> list[str]:
    """Return the names in the first column of the manual's table whose first heading this is."""
    table = DOCS.read_text().partition(f"\n| {heading} |")[2].partition("\n\n")[0]
    return re.findall(r"^\| `(\S+)` ", table, re.MULTILINE)


def test_the_manual_names_every_kind_of_graph() -> None:
    assert _first_column("kind") == list(get_args(GraphKind))


def test_the_manual_names_every_filter() -> None:
    names = [*_first_column("filter"), *_names_in_generator_page("filter")]
    assert sorted(names) == sorted(TEMPLATE_FILTERS)


def test_the_manual_names_every_view() -> None:
    views = json.loads((ROOT / "schemas" / "backend.schema.json").read_text())["$defs"]["view"]["enum"]
    assert sorted(views) == sorted(list_view_names(views))
    generated_views = _names_in_generator_page("view")
    assert generated_views == [name for name in views if name not in DOCUMENT_VIEWS]
    shown_views = [name for name in _first_column("variable") if name in views]
    assert sorted(shown_views[:-1]) == sorted(DOCUMENT_VIEWS)
    assert shown_views[-1] == generated_views[0], "one of those of the other page stands for all"


def _names_in_generator_page(heading: str) -> list[str]:
    """Return the names in the first column of a table of docs/own_generators.md; a row may name several."""
    table = (ROOT / "docs" / "own_generators.md").read_text().partition(f"\n| {heading} |")[2].partition("\n\n")[0]
    cells = re.findall(r"^\| (`[^|]*`) \|", table, re.MULTILINE)
    return [name for cell in cells for name in re.findall(r"`(\w+)`", cell)]
