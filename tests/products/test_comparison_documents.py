"""What changed, as a page that stands by itself and as a picture."""

from __future__ import annotations

import re
from html import unescape
from pathlib import Path

import pytest

from archgen import pipeline
from archgen.compare import Comparison
from archgen.emit.file_tree import OutputError
from archgen.products import comparison_documents
from archgen.products.compared_versions import ProjectVersion, compare_named_versions
from archgen.products.output_options import OutputOptions
from tests import hostile
from tests.emit.markdown.test_comparison_markdown import ROBOT
from tests.products.test_agreement_documents import Page, judge_pages

Made = tuple[Comparison, ProjectVersion, ProjectVersion]


def sides(folder: Path, before: str, after: str) -> Made:
    """Compare two one-file projects."""
    read = []
    for name, text in (("before", before), ("after", after)):
        (folder / name).mkdir(parents=True)
        (folder / name / "robot.yaml").write_text(text, encoding="utf-8")
        read.append(ProjectVersion(name, pipeline.check_project(folder / name / "robot.yaml")))
    old, new = read
    return compare_named_versions(old, new), old, new


def robot(folder: Path) -> Made:
    """Change something of each sort."""
    after = ROBOT.replace("wcet: 20 ms", "wcet: 60 ms").replace(
        "      screen: {", "      lamp: {}\n      screen: {title: Screen 2, "
    )
    return sides(folder, ROBOT, after.replace("sensor_msgs/msg/Image", "sensor_msgs/msg/CompressedImage"))


def evil(folder: Path, text: str) -> Made:
    """Change every text of a hostile project."""
    return sides(folder, hostile.written(hostile.project(text)), hostile.written(hostile.project(f"{text} 2")))


KINDS = ("robot", *hostile.TEXTS)


@pytest.fixture(scope="module", params=KINDS)
def made(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Made:
    return make_comparison(request.param, tmp_path_factory.mktemp("changes"))


def make_comparison(kind: str, folder: Path) -> Made:
    """Compare two states of a small project, or of one with hostile texts."""
    return robot(folder) if kind == "robot" else evil(folder, hostile.TEXTS[kind])


def test_the_page_stands_by_itself(made: Made) -> None:
    html = comparison_documents.render_comparison_html(*made, OutputOptions()).decode()
    page = Page()
    page.feed(html)
    page.close()
    assert page.wrong == []
    assert len(set(page.ids)) == len(page.ids)
    assert set(page.targets) <= set(page.ids)
    assert "This picture could not be drawn" not in html


@pytest.mark.slow
def test_the_nu_checker_finds_nothing(tmp_path: Path) -> None:
    pages = [tmp_path / f"{kind}.html" for kind in KINDS]
    for page in pages:
        made = make_comparison(page.stem, tmp_path / page.stem)
        page.write_bytes(comparison_documents.render_comparison_html(*made, OutputOptions()))
    assert judge_pages(pages) == []


def test_what_the_page_says(tmp_path: Path) -> None:
    html = comparison_documents.render_comparison_html(*robot(tmp_path), OutputOptions()).decode()
    text = unescape(re.sub(r"<[^>]+>", " ", html[html.index("<main") :]))
    said = " ".join(text.split())
    assert "What changed in Robot before → after From before To after Changes 4 changes (1 added, 3 changed)" in said
    assert "Breaks CERTH, SSSA Concerns CERTH, SSSA Breaking changes" in said
    assert (
        "~ Finder of SSSA: worst case execution time 20 ms → 60 ms breaks CERTH (promise): makes the chain see miss its deadline"
        in said
    )
    assert "Other changes Display (SSSA) + component Lamp is added" in said
    assert "see 127 ms 167 ms +40 ms 150 ms missed (was met)" in said
    assert re.search(r"camera of CERTH is on it found as late-chain at robot\.yaml:\d+:10", said)
    assert (
        said.index("Breaking changes")
        < said.index("Pictures")
        < said.index("Latency of chains")
        < said.index("New findings")
    )


def test_no_change_is_one_line(tmp_path: Path) -> None:
    made = sides(tmp_path, ROBOT, f"# a comment\n{ROBOT}")
    html = comparison_documents.render_comparison_html(*made, OutputOptions()).decode()
    assert "No change of the architecture." in html
    assert "<svg" not in html[html.index("<main") :]
    with pytest.raises(OutputError, match="nothing changed that a picture could show"):
        comparison_documents.render_comparison_svg(made[0], OutputOptions())


def test_the_picture_by_itself(tmp_path: Path) -> None:
    svg = comparison_documents.render_comparison_svg(robot(tmp_path)[0], OutputOptions()).decode()
    assert svg.startswith('<?xml version="1.0" encoding="UTF-8"?>\n<svg class="archgen"')
    assert "<title>What changed: components and connections</title>" in svg
    assert "worst case execution time `20 ms` → `60 ms`" in unescape(svg)
    assert "<a " not in svg
    # It looks alike on computers that have no Inter.
    assert svg.count("@font-face") == 2


def test_names_and_command(tmp_path: Path) -> None:
    text = comparison_documents.render_comparison_markdown(*robot(tmp_path))
    assert "`before` → `after`: 1 added, 3 changed" in text
