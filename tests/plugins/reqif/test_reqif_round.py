"""What archgen writes as ReqIF, it reads."""

from __future__ import annotations

from pathlib import Path

from archgen.emit.reqif import render_reqif
from archgen.plugins.reqif.reqif_import import read_requirements
from tests.emit.reqif.test_reqif_writer import exchange, make


def test_a_deep_tree_is_written_and_read(tmp_path: Path) -> None:
    count = 5000
    deep = exchange(
        *(make(f"R-{n}", *([f"R-{n - 1}"] if n else [])) for n in range(count)),
        tree=tuple((f"R-{n}", n) for n in range(count)),
    )
    (tmp_path / "deep.reqif").write_bytes(render_reqif(deep))
    taken = read_requirements(tmp_path / "deep.reqif", ()).requirements
    assert (len(taken), taken["R-4999"]["parent"]) == (count, ["R-4998"])
