"""The parts of the server by themselves, on a small project in memory."""

from __future__ import annotations

from pathlib import Path

import pytest
from lsprotocol import types
from pygls.workspace import PositionCodec

from archgen.diagnostics.diagnostic import Diagnostic, Label, Severity
from archgen.diagnostics.source_span import Span
from archgen.diagnostics.suggested_fixes import apply_edits
from archgen.edit.element_edit import EditRefusedError
from archgen.live.warm_project import EditedProject
from archgen.lsp.answers import (
    ANSWERS,
    OPTIONS,
    RefusedRequestError,
    describe_component,
    find_flow_component,
    list_flows,
)
from archgen.lsp.completion import list_offers
from archgen.lsp.editor_edits import find_findings, list_fixes, plan_certain_edits, plan_edits
from archgen.lsp.element_hints import list_inlays, list_lenses, list_tokens
from archgen.lsp.element_navigation import (
    describe_element,
    describe_key,
    find_declared,
    find_element,
    has_place,
    list_folds,
    list_mentions,
    list_symbols,
    to_place,
    to_range,
)
from archgen.lsp.language_server import create_server, to_message
from archgen.lsp.open_projects import OpenProjects, name_file

ROBOT = """\
archgen: 1
hosts: {pc: {cores: 1}}
groups:
  g:
    title: Group
    components:
      eye: {outputs: {o: std_msgs/msg/Bool, spare: std_msgs/msg/Bool}}
      # It stops
      # what moves.
      brake: {inputs: {i: eye.o}}
nodes:
  eye: {implements: eye, host: pc, timing: {period: 100 ms, wcet: 5 ms, bcet: 5 ms, priority: 3}}
  brake: {implements: brake, host: pc, timing: {behaviour: event, wcet: 5 ms, bcet: 5 ms}}
chains:
  stop: {through: [g.eye, g.brake], deadline: 200 ms}
"""
FILE = "archgen.yaml"
UTF16, UTF32 = PositionCodec(types.PositionEncodingKind.Utf16), PositionCodec(types.PositionEncodingKind.Utf32)


@pytest.fixture
def project(tmp_path: Path) -> EditedProject:
    """Open the robot, checked wholly."""
    (tmp_path / FILE).write_text(ROBOT, encoding="utf-8")
    edited = EditedProject(tmp_path)
    edited.set_text(FILE, ROBOT)
    edited.check_wholly()
    return edited


def place(word: str, offset: int = 0) -> tuple[int, int]:
    """Return line and column of the first place of a word in the robot's file."""
    before = ROBOT[: ROBOT.index(word) + offset]
    return before.count("\n") + 1, len(before) - before.rfind("\n")


def test_positions_are_counted_in_the_units_of_the_client() -> None:
    lines = {1: "a🤖b", 2: ""}
    span = Span(FILE, 1, 3, 2, 1)
    assert to_range(span, lambda _, number: lines.get(number), UTF16).start == types.Position(0, 3)
    assert to_range(span, lambda _, number: lines.get(number), UTF32).start == types.Position(0, 2)
    assert to_range(span, lambda _, number: lines.get(number), UTF32).end == types.Position(1, 0)
    assert to_place(types.Position(0, 3), "a🤖b", UTF16) == (1, 3)
    assert to_place(types.Position(0, 99), "a🤖b", UTF16) == (1, 4)
    assert has_place(span, 1, 3)
    assert not has_place(span, 1, 2)


def test_a_finding_is_told_with_its_help_and_places() -> None:
    label = Label(Span("other.yaml", 2, 1, 2, 4), "declared here")
    finding = Diagnostic("unread-output", "nobody reads", Span(FILE, 1, 1, 1, 3), Severity.NOTE, (label,), "do this")
    message = to_message(finding, lambda _, __: "abc", lambda file: f"file:///{file}", UTF32)
    assert message.message == "nobody reads\nhelp: do this"
    assert (message.severity, message.tags) == (types.DiagnosticSeverity.Information, [types.DiagnosticTag.Unnecessary])
    assert message.related_information is not None
    assert message.related_information[0].location.uri == "file:///other.yaml"


def test_the_nearest_project_has_a_file(tmp_path: Path) -> None:
    inner = tmp_path / "robots" / "one"
    inner.mkdir(parents=True)
    for folder in (tmp_path, inner):
        (folder / FILE).write_text("archgen: 1\n", encoding="utf-8")
    (tmp_path / "packed.yaml").write_text("archgen: 1\n", encoding="utf-8")
    projects = OpenProjects()
    outer_file = projects.open_file((tmp_path / "a.yaml").as_uri(), "")
    inner_file = projects.open_file((inner / "groups" / "a.yaml").as_uri(), "")
    packed = projects.open_file((tmp_path / "packed.yaml").as_uri(), "archgen: 1\n")
    assert outer_file is not None
    assert inner_file is not None
    assert packed is not None
    assert outer_file[1] == "a.yaml"
    assert inner_file[1] == "groups/a.yaml"
    assert len({id(found[0]) for found in (outer_file, inner_file, packed)}) == 3
    assert projects.open_file("untitled:1", "") is None
    assert name_file(inner_file[0], tmp_path / "x.yaml") == "../../x.yaml"
    projects.close_file((tmp_path / "a.yaml").as_uri())
    assert [name for _, name in projects.list_open_files(outer_file[0])] == []


def test_the_outline_and_what_can_be_folded(project: EditedProject) -> None:
    symbols = list_symbols(project, FILE, UTF32)
    assert [symbol.name for symbol in symbols] == ["archgen", "hosts", "groups", "nodes", "chains"]
    (group,) = symbols[2].children or ()
    assert [symbol.name for symbol in group.children or ()] == ["eye", "brake"]
    comment = next(fold for fold in list_folds(project, FILE) if fold.kind)
    assert (comment.start_line, comment.end_line) == (7, 8)


def test_a_word_of_a_path_means_what_holds_the_rest(project: EditedProject) -> None:
    line, column = place("eye.o}}")
    component, output = find_element(project, FILE, line, column), find_element(project, FILE, line, column + 4)
    assert component is not None
    assert output is not None
    assert (component.element, output.element) == (("component", "g.eye"), ("output", "g.eye.o"))
    assert len(list(list_mentions(project, ("component", "g.eye")))) == 4
    assert "**output** `g.eye.o`" in (describe_element(project, output.element, str) or "")
    assert (describe_key(project, FILE, *place("through:")) or "").startswith("`through` - ")
    assert [name.id for name in find_declared(project, "brk")][:1] == ["brake"]


def test_hints_beside_elements(project: EditedProject) -> None:
    lenses = [hint.text for hint in list_lenses(project, FILE)]
    assert "1 reader" in lenses
    assert "no readers" in lenses
    assert any(text.startswith("bound ") and text.endswith(" of 200 ms") for text in lenses)
    assert [hint.text for hint in list_inlays(project, FILE)][:1] == ["/g/eye/o"]
    assert [token.type for token in list_tokens(project, FILE) if token.span.line == 10] == [
        "class",
        "parameter",
        "class",
        "property",
    ]
    project.set_text(FILE, f"{ROBOT}# more\n")
    assert any(hint.text.endswith("(as it was)") for hint in list_lenses(project, FILE))


def test_flow_goes_from_the_eye_to_the_brake(project: EditedProject) -> None:
    assert find_flow_component(project, "output", "g.eye.o") == "g.eye"
    assert find_flow_component(project, "host", "pc") is None
    assert describe_component(project, "g.eye")[0] == "Eye"
    assert [other for other, _ in list_flows(project, "g.eye", is_incoming=False)] == ["g.brake"]
    assert [other for other, _ in list_flows(project, "g.brake", is_incoming=True)] == ["g.eye"]


def test_offers_of_a_place(project: EditedProject) -> None:
    line, column = place("host: pc", 6)
    assert [offer.label for offer in list_offers(project, FILE, line, column)] == ["pc"]
    assert list_offers(project, FILE, 999, 1) == []


def test_fixes_of_a_finding(project: EditedProject) -> None:
    project.set_text(FILE, ROBOT.replace("behaviour: event", "behaviour: Event"))
    project.check_wholly()
    line, _ = place("behaviour")
    (finding,) = (each for each in find_findings(project, FILE, line, line) if each.severity == "error")
    assert [fix.title for fix in list_fixes(project, finding)] == ["write `event`"]
    assert [edit.text for edit in plan_certain_edits(project, FILE)] == ["event"]


def test_what_nothing_declares_can_be_declared(project: EditedProject) -> None:
    text = ROBOT.replace("host: pc, timing: {period", "host: arm_computer, timing: {period")
    project.set_text(FILE, text)
    project.check_wholly()
    (finding,) = (each for each in project.findings if each.severity == "error")
    fix = next(fix for fix in list_fixes(project, finding) if fix.title.startswith("declare"))
    assert fix.title == "declare the host `arm_computer` in archgen.yaml"
    project.set_text(FILE, apply_edits(text, fix.edits))
    assert project.checked.architecture.hosts["arm_computer"].title == "Arm Computer"


def test_a_figure_without_its_unit_has_several_fixes(project: EditedProject) -> None:
    project.set_text(FILE, ROBOT.replace("deadline: 200 ms", "deadline: 0.2"))
    project.check_wholly()
    (finding,) = (each for each in project.findings if each.severity == "error")
    assert [(fix.title, fix.is_preferred) for fix in list_fixes(project, finding)] == [
        ("write `0.2 s`", False),
        ("write `0.2 ms`", False),
    ]


def test_a_rename_is_edits_of_words(project: EditedProject) -> None:
    edits, _ = plan_edits(project, ("component", "g.eye"), "camera")
    assert {edit.text for edit in edits} == {"camera"}
    with pytest.raises(EditRefusedError, match="taken"):
        plan_edits(project, ("component", "g.eye"), "brake")


def test_the_server_says_what_it_can() -> None:
    server = create_server("1")
    assert server.version == "1"
    assert OPTIONS.keys() <= ANSWERS.keys()
    assert set(ANSWERS) <= set(server.protocol.fm.features)
    assert RefusedRequestError("a\x1bb").message == "a␛b"
