"""What a change breaks in variants only: told beside what it breaks in the project itself, each loss once."""

from __future__ import annotations

import json
from pathlib import Path

from archgen import pipeline
from archgen.compare import Comparison
from archgen.emit.data.comparison_json import change_record
from archgen.products.compared_versions import ProjectVersion, compare_named_versions
from archgen.products.merge_breaks import find_breaks

ROBOT = """\
archgen: 1
partners: {sense: {title: Sensing}, move: {title: Moving}}
types: {T: sensor_msgs/msg/LaserScan, U: sensor_msgs/msg/Image}
groups:
  sensing: {owner: sense, components: {lidar: {outputs: {scan: {type: T, promise: {rate: 10 Hz}}}}, radar: {outputs: {echo: T}}}}
  driving: {owner: move, components: {drive: {inputs: {scan: lidar.scan}}}}
nodes: {lidar: lidar, radar: radar, drive: drive}
variants:
  simulation: {changes: {groups: {sensing: {components: {lidar: {outputs: {scan: {promise: {rate: 20 Hz}}}}}}}}}
  copy: {of: simulation}
  rainy: {changes: {groups: {driving: {components: {drive: {inputs: {echo: radar.echo}}}}}}}
"""
WEAKENED = ("promise: {rate: 20 Hz}", "promise: {rate: 12 Hz}")
RETYPED = ("radar: {outputs: {echo: T}}", "radar: {outputs: {echo: U}}")


def compare(folder: Path, *changes: tuple[str, str], before: str = ROBOT) -> Comparison:
    """Compare the robot with one in which some texts are others."""
    after = before
    for old, new in changes:
        assert old in after
        after = after.replace(old, new)
    versions = []
    for name, text in (("before", before), ("after", after)):
        (folder / name).mkdir()
        (folder / name / "robot.yaml").write_text(text, encoding="utf-8")
        versions.append(ProjectVersion(name, pipeline.check_project(folder / name / "robot.yaml")))
    return compare_named_versions(*versions)


def list_breaks(comparison: Comparison) -> list[tuple[str, str, tuple[str, ...]]]:
    return [(change.element_id, each.partner, each.variants) for change in comparison.changes for each in change.breaks]


def test_what_is_weakened_in_variants_only_is_told_with_their_names(tmp_path: Path) -> None:
    comparison = compare(tmp_path, WEAKENED)
    assert list_breaks(comparison) == [("sensing.lidar.scan", "move", ("simulation", "copy"))]
    change = comparison.changes[0]
    assert change.text.startswith("in the variants `simulation` and `copy`: `sensing.lidar.scan`")
    assert change_record(change)["variants"] == ["simulation", "copy"]
    assert change_record(change)["because"][0]["variants"] == ["simulation", "copy"]


def test_a_variant_that_is_renamed_in_the_same_change_is_judged_under_its_new_id(tmp_path: Path) -> None:
    comparison = compare(
        tmp_path, ("  simulation: {", "  in_the_lab: {"), ("of: simulation", "of: in_the_lab"), WEAKENED
    )
    told = [(each.kind, each.element_id, each.old_id) for each in comparison.changes if each.element_kind == "variant"]
    assert [each for each in told if each[0] != "changed"] == [("renamed", "in_the_lab", "simulation")]
    assert list_breaks(comparison) == [("sensing.lidar.scan", "move", ("in_the_lab", "copy"))]


def test_a_change_of_the_project_that_breaks_somebody_in_a_variant_says_in_which(tmp_path: Path) -> None:
    comparison = compare(tmp_path, RETYPED)
    assert list_breaks(comparison) == [("sensing.radar.echo", "move", ("rainy",))]
    assert comparison.changes[0].variants == ()
    assert comparison.changes[0].breaks[0].reason.endswith(", in the variant `rainy`")
    assert "variants" not in json.dumps([change_record(each) for each in comparison.changes[1:]])


def test_what_breaks_in_the_project_itself_is_not_told_again(tmp_path: Path) -> None:
    assert list_breaks(compare(tmp_path, ("lidar: {outputs: {scan: {type: T", "lidar: {outputs: {scan: {type: U"))) == [
        ("sensing.lidar.scan", "move", ())
    ]


def test_breaks_in_variants_are_findings_at_what_changed(tmp_path: Path) -> None:
    comparison = compare(tmp_path, WEAKENED)
    checked = pipeline.check_project(tmp_path / "after" / "robot.yaml")
    (finding,) = find_breaks(comparison, checked)
    assert finding.message.startswith("breaks Moving (promise): in the variants `simulation` and `copy`: ")
    assert finding.span.line == 5


def test_a_partner_agrees_to_what_a_variant_loses(tmp_path: Path) -> None:
    versions = []
    for name, text in (("before", ROBOT), ("after", ROBOT.replace(*WEAKENED))):
        (tmp_path / name / "review").mkdir(parents=True)
        (tmp_path / name / "archgen.yaml").write_text(text, encoding="utf-8")
        versions.append(ProjectVersion(name, pipeline.check_project(tmp_path / name)))
    accepted = "review: {accepted: {sensing.lidar.scan: {key: promise.rate, reason: simulated only}}}\n"
    (tmp_path / "after" / "review" / "move.yaml").write_text(accepted, encoding="utf-8")
    agreed = ProjectVersion("agreed", pipeline.check_project(tmp_path / "after"))
    assert compare_named_versions(versions[0], versions[1]).changes[0].acceptance_reason is None
    comparison = compare_named_versions(versions[0], agreed)
    assert comparison.changes[0].acceptance_reason == "simulated only"
    assert comparison.idle_acceptances == ()


def test_without_partners_or_with_the_gate_off_variants_are_not_compared(tmp_path: Path) -> None:
    policy = "review: {breaking: {wire: off, promise: off, meaning: off, source: off}}\n"
    assert list_breaks(compare(tmp_path, WEAKENED, before=ROBOT + policy)) == []


def test_a_stub_under_the_old_id_of_a_variant_hides_nothing(tmp_path: Path) -> None:
    stub = ("  simulation: {", "  simulation: {changes: {project: {title: Simulated}}}\n  in_the_lab: {")
    assert list_breaks(compare(tmp_path, stub, ("of: simulation", "of: in_the_lab"), WEAKENED)) == [
        ("sensing.lidar.scan", "move", ("in_the_lab", "copy"))
    ]
