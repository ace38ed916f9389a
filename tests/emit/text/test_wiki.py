"""The wiki: templates only, and nothing that a project writes becomes a mark."""

from __future__ import annotations

import sys
from dataclasses import asdict
from pathlib import Path
from types import FrameType
from typing import TYPE_CHECKING

import pytest
from markdown_it import MarkdownIt

from archgen.emit import text
from archgen.emit.backend_manifests import read_shipped_backend
from archgen.emit.markdown.comment_sentences import escape_markdown, make_code_span
from archgen.emit.markdown.mermaid_chart import escape_mermaid, fold_for_mermaid
from archgen.emit.safe_names import make_identifier
from archgen.emit.text.template_filters import (
    draw_mermaid,
    draw_mermaid_sequence,
    safe_commonmark,
)
from archgen.emit.text.template_limits import TemplateLimits
from archgen.emit.text.template_worker import render_request
from archgen.views.picture_shapes import Arrow, Box, Cluster, Graph, Lifeline, SequenceChart, SequenceMessage
from archgen.views.shapes import Column, Facts, Figure, Markdown, Page, Paragraph, Section, Table, Text, shape_to_plain
from tests.running import ROOT, archgen_here

if TYPE_CHECKING:
    from _typeshed import TraceFunction

EVIL = '<script>alert(1)</script> *a* _b_ `c` [d](javascript:e) | ![f](g) {{7*7}} "] end'
HOME = ("Overview", "page:index")


def wiki(title: str) -> dict[str, str]:
    graph = Graph(
        "groups/g",
        "G",
        "group",
        (
            Box("g.a", title, ("10 Hz",), cluster="g", emphasis="subject"),
            Box("t", "/topic", style="topic", emphasis="neighbour"),
        ),
        (Arrow("e", "g.a", "t", label=title, style="service"),),
        (Cluster("g", title),),
        kind="group",
    )
    cells = (
        (Text(title, ref="component:g.a"),),
        (Text(title, code=True),),
        (Text("paper", url="https://example.org/ (1)"),),
    )
    columns = (Column(title), Column("Code"), Column("Link", 1, "right"))
    group = Section(
        "group:g",
        title,
        (
            Facts((("Owner", (Text(title, strong=True),)),)),
            Figure("figure:g", "groups/g", title, ""),
            Table("table:g", title, columns, (cells,)),
        ),
    )
    component = Section("component:g.a", title, (Markdown("Plain *words*."), Markdown(title)))
    pages = (
        Page("index.html", "page:index", title, "overview", Section("page:index", title, ())),
        Page("groups/g.html", "group:g", title, "groups", group, (HOME,), title),
        Page("components/g.a.html", "component:g.a", title, "components", component, (HOME, (title, "group:g"))),
    )
    tree, diagnostics = text.render_backend(
        read_shipped_backend("wiki"), {"pages": pages, "graphs": (graph,), "sequences": ()}
    )
    assert diagnostics == ()
    assert tree is not None
    return {path: data.decode() for path, data in tree.files.items()}


def test_a_page_for_each_group_and_a_start_page() -> None:
    files = wiki("Sensing")
    assert files["home.md"] == "# Sensing\n\n\n## Pages\n\n- [Sensing](groups/g.md): Sensing\n"
    assert files["groups/g.md"] == (
        "# Sensing\n\nSensing\n\n"
        "- **Owner:** **Sensing**\n\n"
        "```mermaid\nflowchart LR\n"
        '  n_t["/topic"]:::neighbour\n'
        '  subgraph n_cluster_20_g["Sensing"]\n'
        '    n_g_2e_a("Sensing<br>10 Hz"):::subject\n'
        "  end\n"
        '  n_g_2e_a -.->|"Sensing"| n_t\n'
        "  classDef neighbour fill:#eeeeee,stroke:#8a8a8a,color:#1b2127\n"
        "  classDef subject stroke:#0072b2,stroke-width:2px\n```\n\n\n"
        "*Sensing*\n\n"
        "**Sensing**\n\n"
        "| Sensing | Code | Link |\n| --- | --- | ---: |\n"
        "| [Sensing](../components/g.a.md) | `Sensing` | [paper](https://example.org/%20%281%29) |\n\n"
        "\n## Components\n\n- [Sensing](../components/g.a.md)\n"
    )
    assert files["components/g.a.md"].rstrip() == "# Sensing\n\n[Sensing](../groups/g.md)\n\nPlain *words*.\n\nSensing"


def _count_template_lines(group_count: int) -> int:
    """Render a wiki of as many groups, with a picture and a component each, and count the lines that its templates run."""
    groups = [f"g{number}" for number in range(group_count)]
    pages = [Page("index.html", "page:index", "Robot", "overview", Section("page:index", "Robot", ()))]
    for name in groups:
        figure = Figure(f"figure:{name}", f"groups/{name}", name, "")
        anchor, crumbs = f"group:{name}", (HOME, (name, f"group:{name}"))
        pages.append(Page(f"{name}.html", anchor, name, "groups", Section(anchor, name, (figure,)), (HOME,)))
        section = Section(f"component:{name}.a", name, (figure,))
        pages.append(Page(f"{name}.a.html", section.anchor, name, "components", section, crumbs))
    graphs = [Graph(f"groups/{name}", name, "group", (Box(name, name),), (), kind="group") for name in groups]
    backend = read_shipped_backend("wiki")
    request = {
        "templates": str(backend.folder / "templates"),
        "files": [asdict(file) for file in backend.files],
        "data": shape_to_plain({"pages": pages, "graphs": graphs, "sequences": ()}),
        "options": {},
        "escapes": {},
        "limits": asdict(TemplateLimits()),
        "is_workspace": False,
    }
    count = 0

    def trace(frame: FrameType, event: str, _: object) -> TraceFunction | None:
        nonlocal count
        count += event == "line"
        return trace if frame.f_code.co_filename.endswith(".j2") else None

    before = sys.gettrace()
    sys.settrace(trace)
    try:
        answer = render_request(request)
    finally:
        sys.settrace(before)
    assert len(answer["files"]) == 2 * group_count + 1
    return count


def test_templates_do_as_much_for_each_page_however_many_there_are() -> None:
    few, more, most = map(_count_template_lines, (20, 40, 80))
    assert most - more < 2.05 * (more - few)


def test_hostile_text_stays_text() -> None:
    page = wiki(EVIL)["groups/g.md"]
    html = MarkdownIt("commonmark", {"html": True}).enable("table").render(page)
    assert "<script" not in html
    assert 'href="javascript' not in html
    assert "<img" not in html
    assert html.count("<td") == 3
    assert f"<h1>{EVIL.replace('<', '&lt;').replace('>', '&gt;').replace(chr(34), '&quot;')}</h1>" in html
    picture = page.partition("```mermaid\n")[2].partition("```")[0]
    assert not set("<>`[]{}|") & set("".join(part for part in picture.split('"')[1::2]).replace("<br>", ""))


@pytest.mark.parametrize(
    ("given", "written"),
    [
        ("1.0", "1.0"),
        ("1. one", "1\\. one"),
        ("- one", "\\- one"),
        ("# one", "\\# one"),
        ("a\nb", "a b"),
        ("snake_case", "snake\\_case"),
        ("a\\b", "a\\\\b"),
    ],
)
def test_markdown(given: str, written: str) -> None:
    assert escape_markdown(given) == written


def test_code_spans_outnumber_their_ticks() -> None:
    assert [make_code_span("a"), make_code_span("a`b"), make_code_span("``"), make_code_span("")] == [
        "`a`",
        "``a`b``",
        "``` `` ```",
        "` `",
    ]


def test_mermaid_labels_hold_no_mark() -> None:
    assert escape_mermaid('a "b" <c> #d; `e`') == "a #34;b#34; #60;c#62; #35;d#59; #96;e#96;"


def test_identifiers_differ_as_their_texts_do() -> None:
    texts = ("a.b", "a_b", "end", "a_2e_b")
    assert [make_identifier(text) for text in texts] == ["n_a_2e_b", "n_a__b", "n_end", "n_a__2e__b"]


@pytest.mark.parametrize(
    "evil", ["<b>x</b>", "a <!-- b -->", "[x](javascript:y)", "![x](data:image/svg+xml;a)", "<file:///x>"]
)
def test_commonmark_with_html_or_strange_addresses_is_shown_as_text(evil: str) -> None:
    html = MarkdownIt("commonmark", {"html": True}).render(safe_commonmark(evil))
    assert "<a" not in html
    assert "<img" not in html
    assert "<b>" not in html
    assert "<!--" not in html


def test_good_commonmark_is_left_as_it_is() -> None:
    good = "See *this* [paper](https://example.org):\n\n- `a < b`\n"
    assert safe_commonmark(good) == good


def test_arrows_between_frames_lead_from_frame_to_frame() -> None:
    """Mermaid would draw a box of its own for a name that it does not know."""
    boxes = (Box("a.x", "X", cluster="a"), Box("b.y", "Y", cluster="b"))
    arrows = (Arrow("e", "a", "b", label="* 2 types\n1. one", style="link"), Arrow("f", "a.x", "b.y", count=3))
    graph = Graph("g", "G", "two-step", boxes, arrows, (Cluster("a", "A"), Cluster("b", "B")), kind="overview")
    assert draw_mermaid(shape_to_plain(graph)).split("\n") == [
        "flowchart LR",
        '  subgraph n_cluster_20_a["A"]',
        '    n_a_2e_x("X")',
        "  end",
        '  subgraph n_cluster_20_b["B"]',
        '    n_b_2e_y("Y")',
        "  end",
        '  n_cluster_20_a ---|"#8203;#42; 2 types<br>#8203;1. one"| n_cluster_20_b',
        '  n_a_2e_x -->|"3"| n_b_2e_y',
    ]


@pytest.mark.parametrize("given", ["text", {"shape": "table"}, None])
def test_what_is_no_graph_is_not_drawn(given: object) -> None:
    with pytest.raises(TypeError, match="`mermaid_graph` takes one of `graphs`"):
        draw_mermaid(given)


def test_above_forty_arrows_a_neighbour_has_one_arrow_to_the_frame() -> None:
    inside = tuple(Box(f"a.{at}", f"A {at}", cluster="a") for at in range(41))
    arrows = tuple(Arrow(f"e{at}", "n", f"a.{at}", "label") for at in range(41))
    graph = Graph("g", "G", "group", (*inside, Box("n", "N")), arrows, (Cluster("a", "A"),), kind="group")
    drawn = draw_mermaid(shape_to_plain(graph)).split("\n")
    assert [line for line in drawn if "-->" in line] == ['  n_n -->|"41"| n_cluster_20_a']
    few = Graph("g", "G", "group", (*inside, Box("n", "N")), arrows[:40], (Cluster("a", "A"),), kind="group")
    assert fold_for_mermaid(few) == few


def test_frames_become_boxes_where_too_many_arrows_are_inside() -> None:
    inside = tuple(Box(f"a.{at}", f"A {at}", cluster="a") for at in range(10))
    arrows = tuple(Arrow(f"e{at}", f"a.{at % 10}", f"a.{at // 10}") for at in range(100))
    graph = Graph("g", "G", "group", inside, arrows, (Cluster("a", "A"),), kind="group")
    assert [box.title for box in fold_for_mermaid(graph).boxes] == ["A"]


def test_a_use_case_has_a_page_with_its_sequence() -> None:
    chart = SequenceChart(
        "sequences/UC-1",
        "Water",
        (Lifeline("The <resident>", "actor"), Lifeline("Ears; end")),
        (
            SequenceMessage(1, 0, 1, 'asks: "water"', "Voice\n5 ms", "physical"),
            SequenceMessage(2, 1, 1, "end", style="inner"),
            SequenceMessage(3, 1, 0, "", "no connection", "broken"),
        ),
    )
    section = Section("use_case:UC-1", "UC-1", (Figure("figure:sequences/UC-1", "sequences/UC-1", "Step by step", ""),))
    pages = (
        Page("index.html", "page:index", "Robot", "overview", Section("page:index", "Robot", ())),
        Page("use_cases/uc-1.html", "use_case:UC-1", "UC-1", "use_cases", section, (HOME,), "Use case"),
    )
    backend = read_shipped_backend("wiki")
    tree, diagnostics = text.render_backend(backend, {"pages": pages, "graphs": (), "sequences": (chart,)})
    assert diagnostics == ()
    assert tree is not None
    files = {path: data.decode() for path, data in tree.files.items()}
    assert "## Use cases\n\n- [UC-1](use_cases/uc-1.md)\n" in files["home.md"]
    assert files["use_cases/uc-1.md"].partition("```mermaid\n")[2].partition("\n```")[0].split("\n") == [
        "sequenceDiagram",
        "  actor p0 as The #60;resident#62;",
        "  participant p1 as Ears#59; end",
        "  p0->>p1: 1 asks#58; #34;water#34;<br>Voice<br>5 ms",
        "  p1->>p1: 2 end",
        "  p1-xp0: 3<br>no connection",
    ]


@pytest.mark.parametrize("given", ["text", {"shape": "graph"}, None])
def test_what_is_no_sequence_is_not_drawn(given: object) -> None:
    with pytest.raises(TypeError, match="`mermaid_sequence` takes one of `sequences`"):
        draw_mermaid_sequence(given)


def test_requirements_have_a_table_and_pages() -> None:
    table = Table("table:requirements", "Requirements", (Column("Id"),), (((Text("R-1", ref="requirement:R-1"),),),))
    section = Section("requirement:R-1", "R-1", (Paragraph((Text("It *stops*"),)),))
    crumb = ("Requirements and use cases", "page:requirements")
    pages = (
        Page("index.html", "page:index", "Robot", "overview", Section("page:index", "Robot", ())),
        Page(
            "requirements.html",
            "page:requirements",
            "Requirements",
            "overview",
            Section("page:requirements", "R", (table,)),
        ),
        Page("requirements/r-1.html", "requirement:R-1", "R-1", "requirements", section, (HOME, crumb), "Requirement"),
    )
    backend = read_shipped_backend("wiki")
    tree, diagnostics = text.render_backend(backend, {"pages": pages, "graphs": (), "sequences": ()})
    assert diagnostics == ()
    assert tree is not None
    home, page = (tree.files[path].decode() for path in ("home.md", "requirements/r-1.md"))
    assert "## Requirements\n" in home
    assert "[R-1](requirements/r-1.md)" in home
    assert "It \\*stops\\*" in page


def test_the_start_up_has_a_page_of_its_own(tmp_path: Path) -> None:
    archgen_here("build", ROOT / "examples" / "bringup", "--only", "wiki", "-o", tmp_path, cwd=tmp_path)
    page = (tmp_path / "wiki" / "start_up.md").read_text(encoding="utf-8")
    assert page.startswith("# Start-up\n")
    assert "```mermaid\nflowchart TB" in page
    assert "| 1 | `set_clock`<br>program on Computer of the robot |" in page
    assert "**needs rights to run as the user root**" in page
    assert "[Start-up](start_up.md)" in (tmp_path / "wiki" / "home.md").read_text(encoding="utf-8")
