"""The report's chapters: which ones, in what order, and the pictures that they show."""

from __future__ import annotations

import base64
from dataclasses import replace
from pathlib import Path

import pytest

from archgen.link.report_chapters import ReportChapters, find_shown_pictures
from archgen.model.document_chapters import GENERATED_CHAPTERS
from archgen.pipeline import check_project


def chapters_of(folder: Path, report: str, files: dict[str, str] | None = None) -> ReportChapters:
    """Write a project with a `report`, and more files, and read its chapters."""
    for name, text in {"archgen.yaml": f"archgen: 1\nreport: {report}\n", **(files or {})}.items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")
    return check_project(folder).chapters


@pytest.mark.parametrize(
    ("report", "order"),
    [
        ("{}", GENERATED_CHAPTERS),
        ("{chapters: }", GENERATED_CHAPTERS),
        ("{chapters: []}", ()),
        ("{chapters: [views, groups, views]}", ("views", "groups")),
        ("{chapters: [docs/own.md, groups, absent.md, nothing]}", ("docs/own.md", "groups")),
    ],
)
def test_chapters_stand_in_the_order_asked_for(tmp_path: Path, report: str, order: tuple[str, ...]) -> None:
    chapters = chapters_of(tmp_path, report, {"docs/own.md": "# Own\n"})
    assert chapters.order == order
    assert {path: chapter.text for path, chapter in chapters.texts.items()} == (
        {"docs/own.md": "# Own\n"} if "docs/own.md" in order else {}
    )


def test_a_project_without_a_report_has_the_usual_chapters(tmp_path: Path) -> None:
    (tmp_path / "archgen.yaml").write_text("archgen: 1\n", encoding="utf-8")
    chapters = check_project(tmp_path).chapters
    assert (chapters.order, chapters.texts) == (GENERATED_CHAPTERS, {})


def test_a_packed_project_holds_its_texts_and_pictures(tmp_path: Path) -> None:
    data = base64.b64encode(b"packed").decode()
    report = f"{{chapters: [own.md], texts: {{own.md: '![a](a.png)'}}, pictures: {{a.png: {data}, b.png: '%%%'}}}}"
    chapters = chapters_of(tmp_path, report, {"a.png": "on disk", "b.png": "on disk"})
    assert chapters.texts["own.md"].text == "![a](a.png)"
    assert chapters.read_picture("./a.png") == b"packed"
    assert chapters.read_picture("b.png") == b"on disk"
    assert chapters.read_pictures() == {"a.png": b"packed"}


def test_pictures_are_those_of_the_chapters_and_svg_brings_its_png(tmp_path: Path) -> None:
    files = {
        "docs/own.md": "![a](a.svg) ![b](../b.png) ![c](absent.png) ![d](https://host/d.png) ![e](a%20b.png)",
        "docs/a.svg": "svg",
        "docs/a.png": "png",
        "docs/a b.png": "blank",
        "b.png": "above",
        "unused.png": "unused",
    }
    chapters = chapters_of(tmp_path, "{chapters: [docs/own.md]}", files)
    assert chapters.read_pictures() == {
        "docs/a.svg": b"svg",
        "docs/a.png": b"png",
        "b.png": b"above",
        "docs/a b.png": b"blank",
    }


@pytest.mark.parametrize("path", ["../secret.png", "/etc/passwd", "..", "docs/../../secret.png", "a\\b.png", "a\0.png"])
def test_a_picture_outside_the_project_is_not_read(tmp_path: Path, path: str) -> None:
    (tmp_path / "secret.png").write_text("secret", encoding="utf-8")
    (tmp_path / "robot").mkdir()
    (tmp_path / "robot" / "a\\b.png").write_text("odd", encoding="utf-8")
    chapters = chapters_of(tmp_path / "robot", "{}")
    assert chapters.read_picture(path) is None


def test_a_picture_is_read_once(tmp_path: Path) -> None:
    chapters = chapters_of(tmp_path, "{}", {"a.png": "first"})
    assert chapters.read_picture("a.png") == b"first"
    (tmp_path / "a.png").write_text("second", encoding="utf-8")
    assert chapters.read_picture("docs/../a.png") == b"first"
    # What was read so far makes no difference between two readings of one project.
    assert replace(chapters, picture_cache={}) == chapters
    assert "first" not in repr(chapters)


def test_pictures_of_a_text() -> None:
    markdown = "![a](x/y%20z.png)\n\n# ![b](b.png)\n\n[no](c.png) `![d](d.png)` ![e](data:image/png;base64,x) ![f]()\n\n![g](s/a:b.png)\n\n<div>![h](h.png)</div>"
    places = [(picture.path, picture.first_line) for picture in find_shown_pictures(markdown)]
    assert places == [("x/y z.png", 1), ("b.png", 3), ("s/a:b.png", 7), ("h.png", 9)]
