"""Backends are found, and a manifest that is not as it should be is named with its place."""

from __future__ import annotations

from pathlib import Path

import pytest

from archgen.emit.backend_manifests import BackendFile, find_backends
from archgen.emit.manifest_parsing import ManifestError, read_valid_manifest

GOOD = "id: mine\ntitle: Mine\nemitter: text\nview: [record, pages]\nfiles:\n  - {template: a.j2, path: a}\n"


WORKSPACE = GOOD.replace("files:", "makes: workspace\nfiles:").replace("path: a}", "path: a, once: true}")


def found_at(tmp_path: Path, manifest: str | bytes, folder: str = "mine") -> list[str]:
    place = tmp_path / "backends" / folder
    place.mkdir(parents=True)
    (place / "backend.yaml").write_bytes(manifest if isinstance(manifest, bytes) else manifest.encode())
    _, diagnostics = find_backends(tmp_path)
    assert {diagnostic.rule for diagnostic in diagnostics} <= {"backend-error"}
    return [f"{d.span}: {d.message}" for d in diagnostics]


def test_the_last_of_repeated_keys_is_the_one_that_is_named(tmp_path: Path) -> None:
    repeated = GOOD.replace("files:", "files: ''\nfiles:").replace("path: a}", "path: a, only: [false]}")
    problem = found_at(tmp_path, repeated)[-1]
    assert problem.startswith("backends/mine/backend.yaml:7:")
    assert problem.endswith("`files.0.only` is not as the schema of backends asks (Type)")


def test_shipped_and_own_backends(tmp_path: Path) -> None:
    assert found_at(tmp_path, GOOD) == []
    backends, _ = find_backends(tmp_path)
    assert {"site", "wiki", "mine"} <= set(backends)
    assert backends["mine"].views == ("record", "pages")
    assert backends["mine"].files == (BackendFile("a.j2", "a"),)
    assert backends["mine"].name == "backends/mine"


def test_the_error_of_a_manifest_that_ships_says_what_is_wrong(tmp_path: Path) -> None:
    (tmp_path / "backend.yaml").write_text("id: mine\ntitle: Mine\nview: graphs\nfiles: []\n")
    with pytest.raises(ManifestError) as error:
        read_valid_manifest(tmp_path, "backends/mine")
    assert "backends/mine/backend.yaml:1:1: the manifest lacks the key `emitter`" in str(error.value)


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
            "4:1: `view` must be one of `outline`, `pages`, `record`, `graphs`, `sequences`, `tables`, `interfaces`, `components`, `plan`, `programs`",
        ),
        (WORKSPACE.replace("once: true", "once: maybe"), "7:31: `files.0.once` must be `true` or `false`"),
        (WORKSPACE.replace("once: true", "executable: [1]"), "7:31: `files.0.executable` must be `true` or `false`"),
        (WORKSPACE.replace("once: true", "expects: x"), "7:5: `files.0` lacks the key `once`"),
        (WORKSPACE.replace("makes: workspace", "makes: documents"), "7:31: `once` goes with `makes: workspace`"),
        (f"{WORKSPACE}needs: [round]\n", "8:9: `needs.0` must be one of `flat`, `no_generics`"),
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


@pytest.mark.parametrize(
    ("escapes", "problem"),
    [
        ("{uml: {ab: x}}", "7:17: `escapes.uml` has the key `ab`: a key is one character"),
        ("{uml: {'': x}}", "7:17: `escapes.uml` has an empty key: a key is one character"),
        ("{uml: {a: x, a: y}}", "7:23: `escapes.uml` has the character `a` twice"),
        ("{uml: {}}", "7:11: `escapes.uml` is not as the schema of backends asks (MinProperties)"),
        ("{uml: {a: [x]}}", "7:17: `escapes.uml.a` is not as the schema of backends asks (Type)"),
        ("{uml: {a: " + 65 * "x" + "}}", "7:17: `escapes.uml.a` is longer than 64 characters"),
        ("{Uml: {a: x}}", "7:11: `escapes` has the key `Uml`: a filter has a lower-case name such as `plantuml`"),
        ("{__class__: {a: x}}", "7:11: `escapes` has the key `__class__`: a filter has a lower-case name"),
        ("{? [a] : {a: x}}", "7:13: this is not YAML: found unhashable key"),
        ("{markdown: {a: x}}", "7:11: there is a filter `markdown` already"),
        ("{e: {a: x}}", "7:11: there is a filter `e` already"),
        ("{safe: {a: x}}", "7:11: there is a filter `safe` already"),
        ("{random: {a: x}}", "7:11: there is a filter `random` already"),
        ("text", "7:1: `escapes` is not as the schema of backends asks (Type)"),
        (
            "{" + ", ".join(f"a{number}: {{a: x}}" for number in range(17)) + "}",
            "7:1: `escapes` has more than 16 entries",
        ),
        (
            "{a: {" + ", ".join(f"{chr(0x4E00 + number)}: x" for number in range(257)) + "}}",
            "7:11: `escapes.a` has more than 256 entries",
        ),
    ],
)
def test_an_escape_that_is_none(tmp_path: Path, escapes: str, problem: str) -> None:
    (message,) = found_at(tmp_path, f"{GOOD}escapes: {escapes}\n")
    assert message.startswith(f"backends/mine/backend.yaml:{problem}")


@pytest.mark.parametrize(
    ("more", "problem"),
    [
        ("makes: tea\n", "7:1: `makes` must be one of `documents`, `workspace`, `file`"),
        (
            "  - {template: b.j2, path: b}\nmakes: file\n",
            "8:1: `makes: file` goes with exactly one entry in `files`, without `for_each`",
        ),
    ],
)
def test_what_a_backend_makes_is_one_word(tmp_path: Path, more: str, problem: str) -> None:
    assert found_at(tmp_path, GOOD + more) == [f"backends/mine/backend.yaml:{problem}"]


def test_a_backend_of_one_file_writes_no_others(tmp_path: Path) -> None:
    many = GOOD.replace("path: a}", "path: a, for_each: pages}") + "makes: file\n"
    place = "backends/mine/backend.yaml:7:1: "
    assert found_at(tmp_path, many) == [
        f"{place}`makes: file` goes with exactly one entry in `files`, without `for_each`"
    ]
    (tmp_path / "backends" / "mine" / "backend.yaml").write_text(GOOD + "makes: file\n")
    backends, diagnostics = find_backends(tmp_path)
    assert (backends["mine"].makes, diagnostics) == ("file", ())
    (tmp_path / "backends" / "mine" / "assets").mkdir()
    _, (diagnostic,) = find_backends(tmp_path)
    assert f"{diagnostic.span}: {diagnostic.message}" == (
        f"{place}`makes: file` goes without `assets/`: they would be further files"
    )


def test_every_shipped_backend_says_what_it_makes(tmp_path: Path) -> None:
    backends, _ = find_backends(tmp_path)
    for backend in backends.values():
        assert f"\nmakes: {backend.makes}\n" in (backend.folder / "backend.yaml").read_text()
