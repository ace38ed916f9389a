"""`archgen slides`: what stands on which slide, with partners or none, with chains or none, with changes."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.cli.conftest import Run
from tests.cli.test_report_documents import PROJECT
from tests.repositories import repository

pptx = pytest.importorskip("pptx")


def _read(file: Path) -> dict[str, str]:
    """Return the text of each slide by its title, tables cell by cell; those of one title joined."""
    slides: dict[str, str] = {}
    for slide in pptx.Presentation(str(file)).slides:
        texts = [shape.text_frame.text for shape in slide.shapes if shape.has_text_frame]
        texts += [cell.text for shape in slide.shapes if shape.has_table for cell in shape.table.iter_cells()]
        title = slide.shapes.title.text.partition("  ")[0]
        slides[title] = slides.get(title, "") + "\n".join(texts)
    return slides


def _write(folder: Path, text: str) -> Path:
    folder.mkdir(exist_ok=True)
    (folder / "archgen.yaml").write_text(text, encoding="utf-8")
    return folder


def test_each_partner_has_a_slide_and_what_changed_stands_first(run: Run, tmp_path: Path) -> None:
    lamp = _write(tmp_path / "lamp", PROJECT)
    repository(lamp, {"archgen.yaml": PROJECT})
    (lamp / "archgen.yaml").write_text(PROJECT.replace("10 Hz", "5 Hz"), encoding="utf-8")
    assert run("slides", "--since", "HEAD", lamp).status == 0
    slides = _read(lamp / "archgen-out" / "slides.pptx")
    titles = [title.partition(": ")[0] for title in slides]
    assert list(dict.fromkeys(titles)) == [
        "Lamp",
        "What changed since HEAD",
        "The architecture at a glance",
        "What partners give each other",
        "Ada",
        "Bob",
        "Open points, by who must act",
    ]
    assert "Light" in slides["Ada"]
    assert "Gives to" in slides["Ada"]
    assert "rate 10\u202fHz → 5\u202fHz" in slides["Bob"]


def test_without_partners_and_chains_there_is_the_picture_alone(run: Run, tmp_path: Path) -> None:
    bare = _write(tmp_path / "bare", "project: {title: Bare}\ngroups: {g: {components: {c: {}}}}\n")
    assert run("slides", bare, "-o", tmp_path / "s.pptx").status == 0
    assert [title for title in _read(tmp_path / "s.pptx") if title not in {"Bare", "Open points, by who must act"}] == [
        "The architecture at a glance"
    ]
    assert "end it in .pptx" in run("slides", bare, "-o", tmp_path / "s.odp").err
    (tmp_path / "house.pptx").write_text("no presentation", encoding="utf-8")
    ran = run("slides", bare, "--template", tmp_path / "house.pptx", "-o", tmp_path / "s.pptx")
    assert (ran.status, "the template is no PowerPoint file" in ran.err) == (2, True)


@pytest.mark.slow
def test_of_forty_partners_and_nine_chains_each_is_there(run: Run, tmp_path: Path) -> None:
    names = [f"p{at}" for at in range(40)]
    partners = ", ".join(f"{name}: {{title: Partner {name}}}" for name in names)
    groups = ["  g0: {owner: p0, components: {c: {outputs: {o: T}, timing: {rate: 10 Hz, wcet: 1 ms}}}}"]
    groups += [
        f"  g{at}: {{owner: p{at}, components: {{c: {{inputs: {{i: g{at - 1}.c.o}}, outputs: {{o: T}}, timing: {{rate: 10 Hz, wcet: 1 ms}}}}}}}}"
        for at in range(1, 40)
    ]
    chains = ", ".join(f"k{at}: {{through: [g{at}.c, g{at + 1}.c], deadline: 1 s}}" for at in range(9))
    text = f"project: {{title: Many}}\npartners: {{{partners}}}\ntypes: {{T: std_msgs/msg/Bool}}\ngroups:\n"
    many = _write(tmp_path / "many", text + "\n".join(groups) + f"\nchains: {{{chains}}}\n")
    assert run("slides", many, "-o", tmp_path / "s.pptx").status == 0
    slides = _read(tmp_path / "s.pptx")
    assert {f"Partner {name}" for name in names} <= set(slides)
    assert all(f"Partner {name}" in slides["What partners give each other"] for name in names)
    assert "The first 8 of 9 have a slide of their own" in slides["Does it react in time?"]
    assert all(f"K{at}" in slides["Does it react in time?"] for at in range(9))
    assert len({f"K{at}" for at in range(9)} & set(slides)) == 8


def _write_row(folder: Path, count: int) -> Path:
    """Write a project of a chain of so many steps."""
    first = "c0: {outputs: {o: T}, timing: {rate: 10 Hz, wcet: 1 ms}}"
    later = "c{0}: {{inputs: {{i: c{1}.o}}, outputs: {{o: T}}, timing: {{rate: 10 Hz, wcet: 1 ms}}}}"
    components = ", ".join([first, *(later.format(at, at - 1) for at in range(1, count))])
    text = "project: {title: Row}\npartners: {ada: {title: Ada}}\ntypes: {T: std_msgs/msg/Bool}\nrequirements: {R-1: It stops at once}\n"
    text += f"groups: {{g: {{owner: ada, components: {{{components}}}}}}}\n"
    text += f"chains: {{stop: {{through: [g.c0, g.c{count - 1}], deadline: 3 s, requirements: [R-1]}}}}\n"
    return _write(folder, text)


@pytest.mark.parametrize(("count", "has_reasons"), [(3, True), (8, False)])
def test_the_steps_of_a_chain_fill_its_slide(run: Run, tmp_path: Path, *, count: int, has_reasons: bool) -> None:
    assert run("slides", _write_row(tmp_path / "row", count), "-o", tmp_path / "s.pptx").status == 0
    (slide,) = [each for each in pptx.Presentation(str(tmp_path / "s.pptx")).slides if each.shapes.title.text == "Stop"]
    (table,) = [shape for shape in slide.shapes if shape.has_table]
    (picture,) = [shape for shape in slide.shapes if not shape.has_text_frame and not shape.has_table]
    rows = [[cell.text for cell in row.cells] for row in table.table.rows]
    assert [(row[0], row[1]) for row in rows[1:]] == [(f"c{at}", "Ada") for at in range(count)]
    assert (rows[0][-1] == "Why") is has_reasons
    assert (table.left < picture.left + picture.width) is has_reasons
    assert "R-1 It stops at once" in _read(tmp_path / "s.pptx")["Stop"]


def test_more_steps_than_stand_beside_a_picture_have_slides_of_their_own_with_reasons(run: Run, tmp_path: Path) -> None:
    assert run("slides", _write_row(tmp_path / "row", 14), "-o", tmp_path / "s.pptx").status == 0
    slides = list(pptx.Presentation(str(tmp_path / "s.pptx")).slides)
    (drawn,) = [
        each for each in slides if each.shapes.title.text.startswith("Stop") and "steps" not in each.shapes.title.text
    ]
    assert not any(shape.has_table for shape in drawn.shapes), (
        "the rest of the table stood alone at the right of a second one"
    )
    tables = [
        shape.table
        for each in slides
        for shape in each.shapes
        if each.shapes.title.text.startswith("Stop: its steps") and shape.has_table
    ]
    rows = [[cell.text for cell in row.cells] for table in tables for row in list(table.rows)[1:]]
    assert [row[0] for row in rows] == [f"c{at}" for at in range(14)]
    assert tables[0].cell(0, 5).text == "Why"
