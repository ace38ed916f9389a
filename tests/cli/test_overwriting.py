"""What `-o` may replace: what archgen wrote in the same format, and nothing of anybody else's."""

from __future__ import annotations

import io
import zipfile
from collections.abc import Sequence
from pathlib import Path

import pytest

from archgen.emit.own_file_marks import name_written_format
from tests import repositories
from tests.cli.conftest import Run
from tests.property_sizes import try_some

PROJECT = """\
archgen: 1
project: {id: x}
partners: {one: {title: One}, two: {title: Two}}
groups:
  g: {owner: one, components: {a: {outputs: {o: T}}}}
  h: {owner: two, components: {b: {inputs: {i: a.o}}}}
"""
EARLIER = PROJECT.replace("i: a.o", "j: a.o")
BACKEND = "id: table\ntitle: T\nemitter: text\nmakes: file\nview: record\nfiles: [{template: t, path: t}]\n"
VERBS: dict[str, tuple[str, ...]] = {
    "report": ("report", "--no-history", "--format", "docx"),
    "pack": ("pack",),
    "resolved": ("pack", "--resolved"),
    "owners": ("owners",),
    "codeowners": ("owners", "--format", "codeowners"),
    "diff.txt": ("diff", "HEAD^"),
    "same.txt": ("diff", "HEAD"),
    "breaking.txt": ("diff", "HEAD^", "--breaking"),
    "diff.json": ("diff", "HEAD^", "--format", "json"),
    "same.json": ("diff", "HEAD", "--format", "json"),
    "diff.md": ("diff", "HEAD^", "--format", "markdown"),
    "breaking.md": ("diff", "HEAD^", "--format", "markdown", "--breaking"),
    "diff.html": ("diff", "HEAD^", "--format", "html"),
    "diff.svg": ("diff", "HEAD^", "--format", "svg"),
    "agreement.md": ("interfaces", "--between", "one", "two", "--format", "markdown"),
    "agreement.html": ("interfaces", "--between", "one", "two", "--format", "html"),
    "agreement.docx": ("interfaces", "--between", "one", "two", "--format", "docx"),
}


@pytest.fixture
def robot(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """Give a project of two commits, as the current folder."""
    folder = repositories.repository(tmp_path / "robot", {"archgen.yaml": EARLIER})
    repositories.commit(folder, {"archgen.yaml": PROJECT})
    monkeypatch.chdir(folder)
    return folder


def _write_strange_document(text: str) -> bytes:
    """Return a Word document as another program writes it."""
    data = io.BytesIO()
    with zipfile.ZipFile(data, "w") as archive:
        archive.writestr("[Content_Types].xml", "<Types/>")
        archive.writestr("docProps/app.xml", f"<Properties><Application>{text}</Application></Properties>")
        archive.writestr("word/document.xml", "<document/>")
    return data.getvalue()


def _damage_document(data: bytes) -> bytes:
    """Return a zip whose list of files is sound and whose compressed parts are not."""
    packed = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(data)) as archive, zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as copy:
        for name in archive.namelist():
            copy.writestr(name, archive.read(name) * 50)
    damaged = bytearray(packed.getvalue())
    start = damaged.index(b"docProps/app.xml") + len(b"docProps/app.xml")
    damaged[start : start + 8] = b"\xff" * 8
    return bytes(damaged)


SOME_VERBS = try_some([(words,) for words in VERBS.values()], 5)
STRANGE_FILES: dict[str, bytes] = {
    "notes.txt": b"Remember the milk.\n",
    "thesis.docx": _write_strange_document("Microsoft Office Word"),
    "damaged.docx": _damage_document(_write_strange_document("archgen")),
    "plain.zip": b"PK\x03\x04 no zip at all",
    "other/archgen.yaml": b"archgen: 1\nproject: {id: other}\n",
    "page.html": b'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"><title>My page</title></head></html>\n',
    "drawing.svg": b'<?xml version="1.0"?>\n<svg xmlns="http://www.w3.org/2000/svg"/>\n',
    "data.json": b'{\n  "version": 1,\n  "mine": []\n}\n',
    "picture.png": b"\x89PNG\r\n\x1a\n\0\0",
    "CODEOWNERS": b"* @me\n",
}


@pytest.mark.parametrize("words", SOME_VERBS, ids=VERBS)
def test_a_file_of_somebody_else_is_left_as_it_is(run: Run, robot: Path, words: Sequence[str]) -> None:
    for name, content in STRANGE_FILES.items():
        file = robot / name
        file.parent.mkdir(exist_ok=True)
        file.write_bytes(content)
        ran = run(*words, "-o", file)
        assert ran.status == 2
        if words[0] == "pack" and file.suffix not in {"", ".yaml"}:
            assert f"what is packed is YAML: end `{name}` in .yaml" in ran.err
        else:
            assert f"{file} is no " in ran.err
            assert ran.err.endswith("; nothing was changed; give another name with `-o`, or move that file away\n")
        assert "Traceback" not in ran.err
        assert file.read_bytes() == content


@pytest.mark.parametrize("words", SOME_VERBS, ids=VERBS)
def test_what_archgen_wrote_is_replaced_by_the_same_format_of_another_project(
    run: Run, robot: Path, words: Sequence[str]
) -> None:
    file = robot / "file"
    for text in (PROJECT, PROJECT.replace("i: a.o", "k: a.o").replace("title: One", "title: 'Uno, é'")):
        (robot / "archgen.yaml").write_text(text, encoding="utf-8")
        ran = run(*words, "-o", file)
        assert f"wrote {file.name}" in ran.out, ran.err
        with file.open("rb") as stream:
            assert name_written_format(stream)


@pytest.mark.parametrize("words", SOME_VERBS, ids=VERBS)
def test_an_empty_file_and_a_new_one_are_written(run: Run, robot: Path, words: Sequence[str]) -> None:
    (robot / "file").touch()
    assert "wrote file" in run(*words, "-o", robot / "file").out


@pytest.mark.parametrize(
    ("first", "second", "reason"),
    [
        (("pack",), ("pack", "--resolved"), "is no resolved model that archgen wrote"),
        (("owners",), ("pack",), "is no packed project that archgen wrote"),
        (("pack",), ("export", "table"), "is a packed project"),
        (("diff", "HEAD^", "--format", "json"), ("diff", "HEAD^"), "is no plain comparison that archgen wrote"),
    ],
)
def test_one_output_does_not_replace_another(
    run: Run, robot: Path, first: Sequence[str], second: Sequence[str], reason: str
) -> None:
    _add_backend(robot, "made\n")
    run(*first, "-o", robot / "file")
    content = (robot / "file").read_bytes()
    assert reason in run(*second, "-o", robot / "file").err
    assert (robot / "file").read_bytes() == content


def _add_backend(robot: Path, template: str) -> None:
    (robot / "backends/table/templates").mkdir(parents=True, exist_ok=True)
    (robot / "backends/table/backend.yaml").write_text(BACKEND, encoding="utf-8")
    (robot / "backends/table/templates/t").write_text(template, encoding="utf-8")


def test_an_export_replaces_text_and_nothing_else(run: Run, robot: Path) -> None:
    for template in ("a;b\n", "é\n"):
        _add_backend(robot, template)
        assert run("export", "table", "-o", robot / "table.csv").status == 0
        assert (robot / "table.csv").read_text(encoding="utf-8") == template
    for name in ("thesis.docx", "plain.zip", "picture.png", "other/archgen.yaml"):
        (robot / name).parent.mkdir(exist_ok=True)
        (robot / name).write_bytes(STRANGE_FILES[name])
        assert run("export", "table", "-o", robot / name).status == 2
        assert (robot / name).read_bytes() == STRANGE_FILES[name]


def test_a_report_that_another_program_saved_is_kept(run: Run, robot: Path) -> None:
    """Somebody may have written into it."""
    report = robot / "archgen-out" / "report.docx"
    assert run("report", "--no-history").status == 0
    assert run("report", "--no-history").status == 0
    report.write_bytes(_write_strange_document("LibreOffice/24.2"))
    ran = run("report", "--no-history")
    assert (ran.status, "is no Word document that archgen wrote" in ran.err) == (2, True)


def test_a_report_in_a_template_bears_the_mark_of_archgen(run: Run, robot: Path) -> None:
    assert run("report", "--no-history", "-o", robot / "first.docx").status == 0
    for _ in range(2):
        words = ("report", "--no-history", "--template", robot / "first.docx", "-o", robot / "second.docx")
        assert run(*words).status == 0
