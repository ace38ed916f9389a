"""Backends are found, and a manifest that is not as it should be is named with its place."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.emit.backend_manifests import BackendFile, find_backends

GOOD = "id: mine\ntitle: Mine\nemitter: text\nview: [record, pages]\nfiles:\n  - {template: a.j2, path: a}\n"


def found_at(tmp_path: Path, manifest: str | bytes, folder: str = "mine") -> list[str]:
    place = tmp_path / "backends" / folder
    place.mkdir(parents=True)
    (place / "backend.yaml").write_bytes(manifest if isinstance(manifest, bytes) else manifest.encode())
    _, diagnostics = find_backends(tmp_path)
    assert {diagnostic.rule for diagnostic in diagnostics} <= {"backend-error"}
    return [f"{d.span}: {d.message}" for d in diagnostics]


def test_shipped_and_own_backends(tmp_path: Path) -> None:
    assert found_at(tmp_path, GOOD) == []
    backends, _ = find_backends(tmp_path)
    assert {"site", "wiki", "mine"} <= set(backends)
    assert backends["mine"].views == ("record", "pages")
    assert backends["mine"].files == (BackendFile("a.j2", "a"),)
    assert backends["mine"].name == "backends/mine"


def test_a_project_without_backends(tmp_path: Path) -> None:
    backends, diagnostics = find_backends(tmp_path)
    assert diagnostics == ()
    assert "wiki" in backends


@pytest.mark.parametrize(
    ("manifest", "said"),
    [
        ("", "1:1: the manifest lacks the key `id`"),
        (GOOD.replace("title: Mine\n", ""), "1:1: the manifest lacks the key `title`"),
        (GOOD + "colour: red\n", "1:1: the manifest has an unknown key `colour`"),
        (GOOD.replace("text", "tex"), "3:1: `emitter` must be one of `text`, `docx`, `site`, `graphviz`"),
        (
            GOOD.replace("[record, pages]", "all"),
            "4:1: `view` must be `outline`, `pages`, `record`, `graphs` or `tables`",
        ),
        (GOOD.replace("path: a", "way: a"), "6:5: `files.0` has an unknown key `way`"),
        (GOOD.replace("id: mine", "id: Mine"), "1:1: `id` is not as the schema of backends asks (Pattern)"),
        (GOOD.replace("id: mine", "id: other"), "1:1: the id is `other`, but the folder is `mine`"),
        (
            GOOD.replace("emitter: text", "emitter: site"),
            "1:1: a project's own backend has the emitter `text`, not `site`",
        ),
        (GOOD.partition("files")[0], "1:1: the manifest lacks the key `files`"),
        ("id: [\n", "2:1: this is not YAML"),
        ("a: &x [1]\nb: *x\n", "2:1: a manifest is plain: this is an alias"),
        ("[" * 30, "1:1: a manifest is plain: this is nested more than 20 deep"),
        ("- a\n", "1:1: the manifest is not as the schema of backends asks (Type)"),
        ("a: 1\n---\nb: 2\n", "2:1: this is not YAML"),
        (b"\xff\xfe\x00", "1:1: `backend.yaml` is not UTF-8 text"),
        ("id: \x00", "1:1: this is not YAML"),
        ("x" * 70_000, "1:1: `backend.yaml` has more than 65536 bytes"),
    ],
)
def test_a_manifest_that_is_not_as_it_should_be(tmp_path: Path, manifest: str, said: str) -> None:
    assert any(line.startswith(f"backends/mine/backend.yaml:{said}") for line in found_at(tmp_path, manifest))


def test_a_shipped_backend_is_not_replaced(tmp_path: Path) -> None:
    manifest = GOOD.replace("id: mine", "id: wiki")
    assert found_at(tmp_path, manifest, "wiki") == ["backends/wiki/backend.yaml:1:1: there is a backend `wiki` already"]


def test_a_backend_that_is_a_link_or_no_file(tmp_path: Path) -> None:
    (tmp_path / "elsewhere").mkdir()
    (tmp_path / "elsewhere" / "backend.yaml").write_text(GOOD)
    (tmp_path / "backends").mkdir()
    (tmp_path / "backends" / "mine").symlink_to(tmp_path / "elsewhere")
    (tmp_path / "backends" / "odd" / "backend.yaml").mkdir(parents=True)
    _, diagnostics = find_backends(tmp_path)
    assert [d.message for d in diagnostics] == [
        "`backends/mine` is a link; a backend's folder stands in the project",
        "`backend.yaml` is not a file",
    ]
