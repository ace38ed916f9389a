"""`archgen import` and `archgen export reqif`: there and back, updates, and what is refused."""

from __future__ import annotations

from pathlib import Path
from xml.etree import ElementTree as ET

import pytest

from archgen.pipeline import check_project
from tests.cli.conftest import Run

DOORS = Path(__file__).parent / "doors.reqif"
PROJECT = """\
archgen: 1
project: {id: robot, title: "Robot <1> & \\"2\\""}
use_cases: {UC-1: Walks}
chains: {see: {through: [a, b], deadline: 1 s, requirements: [R-1.1]}}
groups: {g: {components: {a: {requirements: [R-1.2], outputs: {o: std_msgs/msg/Bool}}, b: {inputs: {o: a.o}}}}}
"""
REQUIREMENTS = """\
requirements:
  R-1: {title: "Safe & <sound> \\"quoted\\"", kind: safety, priority: must, source: "D3, 4", tags: [x, y]}
  R-1.2:
    title: Slow
    parent: [R-2, R-1]
    description: "One  two\\n\\n    code\\n- item\\n\\n\\n\\n\\u00a0end &amp; <b>"
    rationale: "*Because*"
    verified_by: [UC-1, "By hand, twice", see]
  R-2: {title: Quiet, use_cases: [UC-1]}
  R-1.1: {title: Stops, parent: R-1, verified_by: see}
"""


@pytest.fixture
def project(tmp_path: Path) -> Path:
    folder = tmp_path / "robot"
    folder.mkdir()
    (folder / "archgen.yaml").write_text(PROJECT, encoding="utf-8")
    return folder


def export(run: Run, project: Path) -> bytes:
    target = project.parent / "out.reqif"
    assert run("export", "reqif", "-C", str(project), "-o", str(target)).status == 0
    return target.read_bytes()


def test_what_is_exported_comes_back_as_it_was(run: Run, project: Path) -> None:
    (project / "requirements.yaml").write_text(REQUIREMENTS, encoding="utf-8")
    before, first = check_project(project).architecture.requirements, export(run, project)
    (project / "requirements.yaml").unlink()
    (project.parent / "archgen.yaml").unlink(missing_ok=True)
    text = PROJECT.replace(", requirements: [R-1.1]", "").replace("requirements: [R-1.2], ", "")
    (project / "archgen.yaml").write_text(text, encoding="utf-8")
    done = run("import", str(project.parent / "out.reqif"), "-C", str(project))
    assert (done.status, done.err) == (0, "")
    assert done.out.splitlines()[:2] == [
        "out.reqif: 7 objects: 7 taken",
        "requirements.yaml: 4 new, 0 changed, 0 as before",
    ]
    (project / "archgen.yaml").write_text(PROJECT, encoding="utf-8")
    after = check_project(project).architecture.requirements
    assert list(after) == list(before)
    assert {k: v for k, v in after.items() if k != "R-1.2"} == {k: v for k, v in before.items() if k != "R-1.2"}
    assert after["R-1.2"].description == "One  two\n\n    code\n- item\n\n end &amp; <b>"
    assert after["R-1.2"].verified_by == before["R-1.2"].verified_by
    assert export(run, project) == first


def test_an_update_keeps_what_the_file_does_not_say(run: Run, project: Path) -> None:
    slice_file = project / "requirements.yaml"
    slice_file.write_text(
        "# ours\nrequirements:\n  R-2: {title: Old, verified_by: by hand, source: 1.10}\n"
        "  # a comment\n  R-0: Only here\n",
        encoding="utf-8",
    )
    done = run("import", str(DOORS), "-C", str(project))
    lines = done.out.splitlines()
    start = lines.index("requirements.yaml: 2 new, 1 changed, 0 as before")
    assert lines[start + 1 :] == ["  no longer in the file, kept: R-0", f"wrote {slice_file}"]
    requirement = check_project(project).architecture.requirements["R-2"]
    assert (requirement.title, requirement.priority) == ("The robot stops in time.", "Must_have")
    assert [each.text for each in requirement.verified_by] == ["by hand"]
    assert slice_file.read_text(encoding="utf-8").startswith("# ours\n")
    again = run("import", str(DOORS), "-C", str(project)).out
    assert "requirements.yaml: 0 new, 0 changed, 3 as before" in again


def test_what_another_file_says_stays_there(run: Run, project: Path) -> None:
    (project / "more.yaml").write_text("requirements: {R-2: {title: Ours, description: More}}\n", encoding="utf-8")
    done = run("import", str(DOORS), "-C", str(project))
    assert "  said otherwise in another file, kept: title of R-2" in done.out.splitlines()
    requirement = check_project(project).architecture.requirements["R-2"]
    assert (requirement.title, requirement.description, requirement.priority) == ("Ours", "More", "Must_have")


def test_a_dry_run_and_errors_write_nothing(run: Run, project: Path, tmp_path: Path) -> None:
    assert run("import", str(DOORS), "-C", str(project), "--dry-run").status == 0
    bad = tmp_path / "bad.reqif"
    bad.write_text("<html/>", encoding="utf-8")
    done = run("import", str(bad), "-C", str(project))
    assert (done.status, done.out) == (1, "")
    assert done.err.startswith("error: bad.reqif:1:1: its outermost element is `html`, not `REQ-IF`")
    bad.write_text("<REQ-IF/>", encoding="utf-8")
    done = run("import", str(bad), "-C", str(project))
    assert (done.status, "no requirement" in done.err) == (1, True)
    (project / "mixed.yaml").write_text("hosts: {pc: }\n", encoding="utf-8")
    done = run("import", str(DOORS), "-C", str(project), "--into", str(project / "mixed.yaml"))
    assert (done.status, "`hosts` stands in this file" in done.err) == (1, True)
    done = run("import", str(DOORS), "-C", str(project), "--into", str(tmp_path / "out.yaml"))
    assert (done.status, "does not lie in the project's folder" in done.err) == (2, True)
    done = run("import", str(DOORS), "-C", str(project / "archgen.yaml"), "--into", str(tmp_path / "out.yaml"))
    assert done.status != 0
    assert sorted(path.name for path in project.iterdir()) == ["archgen.yaml", "mixed.yaml"]


def test_a_slice_that_the_project_does_not_read_is_told(run: Run, project: Path) -> None:
    (project / "archgen.yaml").write_text(PROJECT + 'sources: ["groups/*.yaml"]\n', encoding="utf-8")
    text = (project / "archgen.yaml").read_text(encoding="utf-8")
    text = text.replace(", requirements: [R-1.1]", "").replace("requirements: [R-1.2], ", "")
    (project / "archgen.yaml").write_text(text, encoding="utf-8")
    done = run("import", str(DOORS), "-C", str(project))
    assert (done.status, "add `requirements.yaml` to `sources`" in done.err) == (0, True)


def test_comments_stay_where_they_are(run: Run, project: Path) -> None:
    slice_file = project / "requirements.yaml"
    slice_file.write_text(
        "# ours\n\nrequirements:   # all of them\n  # above R-2\n  R-2:  # behind R-2\n    title: Old  # behind the title\n"
        "    # inside\n    verified_by: by hand # behind the key\n    source: 1.10\n    hints: {ours: {slot: 3}}\n"
        "  # above R-0\n  R-0: Only here   # short\n  R-9: {title: 'Flow # no comment'} # flow\n# at the end\n",
        encoding="utf-8",
    )
    done = run("import", str(DOORS), "-C", str(project))
    assert (done.status, "written anew" in done.out) == (0, False)
    text = slice_file.read_text(encoding="utf-8")
    lines = [line.strip() for line in text.splitlines()]
    for above, below in (("# above R-2", "R-2:  # behind R-2"), ("# above R-0", "R-0: Only here   # short")):
        assert lines[lines.index(above) + 1] == below
    for comment in (
        "# ours",
        "# all of them",
        "# behind the title",
        "# inside",
        "# behind the key",
        "# flow",
        "# at the end",
    ):
        assert text.count(comment) == 1
    hints = check_project(project).architecture.requirements["R-2"].annotations.hints
    assert hints == {"ours": {"slot": 3}, "reqif": {"identifier": "_2", "id": "2"}}
    again = run("import", str(DOORS), "-C", str(project))
    assert "0 new, 0 changed, 3 as before" in again.out
    assert slice_file.read_text(encoding="utf-8") == text


def test_a_requirement_is_found_again_under_another_id(run: Run, project: Path) -> None:
    slice_file = project / "requirements.yaml"
    assert run("import", str(DOORS), "-C", str(project)).status == 0
    renamed = slice_file.read_text(encoding="utf-8").replace("Bremse-4:", "B-1:").replace("  R-2:", "  S-2:")
    slice_file.write_text(renamed.replace("- R-2", "- S-2"), encoding="utf-8")
    done = run("import", str(DOORS), "-C", str(project))
    assert "0 new, 0 changed, 3 as before" in done.out
    assert set(check_project(project).architecture.requirements) == {"S-2", "B-1", "Hoehe-3"}


def test_a_relation_that_closes_a_circle_is_left_out_and_listed(run: Run, project: Path, tmp_path: Path) -> None:
    text = DOORS.read_text(encoding="utf-8")
    circle = text.replace(
        "<rq:SPEC-RELATIONS>",
        "<rq:SPEC-RELATIONS><rq:SPEC-RELATION><rq:TYPE><rq:SPEC-RELATION-TYPE-REF>r-refines</rq:SPEC-RELATION-TYPE-REF></rq:TYPE>"
        "<rq:SOURCE><rq:SPEC-OBJECT-REF>_2</rq:SPEC-OBJECT-REF></rq:SOURCE>"
        "<rq:TARGET><rq:SPEC-OBJECT-REF>_4</rq:SPEC-OBJECT-REF></rq:TARGET></rq:SPEC-RELATION>",
    )
    (tmp_path / "circle.reqif").write_text(circle, encoding="utf-8")
    done = run("import", str(tmp_path / "circle.reqif"), "-C", str(project))
    assert done.status == 0
    told = "  relation not taken: `Bremse-4` is a part of `R-2`, which would be a part of itself"
    assert told in done.out.splitlines()
    requirements = check_project(project).architecture.requirements
    assert (requirements["R-2"].parents, requirements["Bremse-4"].parents) == (("Bremse-4",), ("Hoehe-3",))


def test_what_came_from_another_tool_goes_back_as_it_is_called_there(run: Run, project: Path) -> None:
    (project / "archgen.yaml").write_text("archgen: 1\nproject: {id: robot}\ngroups: {g: }\n", encoding="utf-8")
    assert run("import", str(DOORS), "-C", str(project)).status == 0
    sent = export(run, project)
    root = ET.fromstring(sent)  # noqa: S314 - our own file
    names = {
        element.get("IDENTIFIER"): {value.get("THE-VALUE") for value in element.iter() if value.get("THE-VALUE")}
        for element in root.iter()
        if element.tag.endswith("}SPEC-OBJECT")
    }
    assert names.keys() == {"_2", "_3", "_4"}
    assert ("Höhe 3" in names["_3"], "Bremse 4" in names["_4"], "2" in names["_2"]) == (True, True, True)
    references = {element.text for element in root.iter() if element.tag.endswith("}SPEC-OBJECT-REF")}
    assert references == {"_2", "_3", "_4"}
    (project / "requirements.yaml").unlink()
    assert run("import", str(project.parent / "out.reqif"), "-C", str(project)).status == 0
    assert export(run, project) == sent
