"""The page docs/api.md runs as it stands, and a backend as docs/backends.md describes it."""

from __future__ import annotations

import re
import subprocess
import sys
from pathlib import Path

import pytest

import archgen

ROOT = Path(__file__).resolve().parents[1]


def _code_blocks(page: str, language: str) -> list[str]:
    text = (ROOT / "docs" / page).read_text(encoding="utf-8")
    return re.findall(rf"```{language}\n(.*?)```", text, re.DOTALL)


@pytest.mark.slow
def test_the_api_page_runs(tmp_path: Path) -> None:
    """On the case study: what it writes goes into a folder of its own; the agreement's revision is one that exists."""
    (code,) = _code_blocks("api.md", "python")
    code = code.replace('"example_ramcip"', repr(str(ROOT / "example_ramcip"))).replace(', since="v1.0"', "")
    done = subprocess.run(  # noqa: S603 - the project's own page
        [sys.executable, "-c", code], cwd=tmp_path, capture_output=True, text=True, check=False, timeout=600
    )
    assert done.returncode == 0, done.stderr[-2000:]
    written = {path.name for path in tmp_path.iterdir()}
    assert written == {"report.docx", "site", "diagrams", "packed.yaml", "certh-sssa.docx"}


def test_the_manuals_backend_runs(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    manifest = _code_blocks("backends.md", "yaml")[0]
    template = _code_blocks("backends.md", "jinja")[0]
    folder = tmp_path / "backends" / "node_list"
    (folder / "templates").mkdir(parents=True)
    (folder / "backend.yaml").write_text(manifest, encoding="utf-8")
    (folder / "templates" / "nodes.md.j2").write_text(template, encoding="utf-8")
    (folder / "templates" / "node.md.j2").write_text("# {{ item.title|markdown }}\n", encoding="utf-8")
    (tmp_path / "archgen.yaml").write_text(
        "archgen: 1\nproject: {id: x}\ngroups: {g: {components: {c: {outputs: {o: std_msgs/msg/Bool}}}}}\nnodes: {n: c}\n",
        encoding="utf-8",
    )
    assert archgen.load(tmp_path).ok
    from archgen.__main__ import main

    monkeypatch.setattr(
        sys, "argv", ["archgen", "build", str(tmp_path), "--only", "node_list", "--backend", "node_list"]
    )
    with pytest.raises(SystemExit):
        main()
    output = tmp_path / "archgen-out" / "node_list"
    assert "- [" in (output / "nodes.md").read_text(encoding="utf-8")
    assert list((output / "nodes").iterdir())
