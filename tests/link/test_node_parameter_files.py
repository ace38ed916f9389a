"""Parameter files: which section is for which node, what a packed file keeps, and what is not read."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import pytest

from archgen import pipeline
from archgen.checking.checked_packing import pack_checked_project
from archgen.link import node_parameter_files
from archgen.link.parameter_texts import matches_node_name
from archgen.model.parameter_values import find_effective_parameters
from archgen.syntax.yaml_writer import write_yaml

PROJECT = """
archgen: 1
groups: {g: {components: {c: {title: C, parameters: {gain: {type: float}}}}}}
nodes: {n: {implements: c, parameter_files: [config/a.yaml]}}
"""


def check(folder: Path, files: Mapping[str, str]) -> pipeline.CheckedProject:
    for name, text in files.items():
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text, encoding="utf-8")
    return pipeline.check_project(folder)


def pack(checked: pipeline.CheckedProject) -> str:
    packed = pack_checked_project(checked)
    return write_yaml(packed.data, packed.comments)


def effective(checked: pipeline.CheckedProject, node: str) -> dict[str, tuple[object, str]]:
    parameters = find_effective_parameters(checked.architecture, checked.architecture.nodes[node])
    return {name: (each.value, each.origin) for name, each in parameters.items()}


@pytest.mark.parametrize(
    ("pattern", "name", "is_match"),
    [
        ("/a/b", "/a/b", True),
        ("b", "/a/b", False),
        ("/**", "/a/b", True),
        ("/**", "/b", True),
        ("/*", "/b", True),
        ("/*", "/a/b", False),
        ("/*/b", "/a/b", True),
        ("/**/b", "/b", True),
        ("/**/b", "/a/c/b", True),
        ("/a/**", "/a", True),
        ("/a/**/c", "/a/b/c", True),
        ("/a/**/c", "/a/b/d", False),
        ("/**/a/**/a", "/a/a", True),
        ("/" + "**/a/" * 30 + "b", "/" + "a/" * 40 + "c", False),
    ],
)
def test_a_pattern_covers_the_names_that_ros_2_lets_it_cover(pattern: str, name: str, *, is_match: bool) -> None:
    parts = [tuple(part for part in each.split("/") if part) for each in (pattern, name)]
    assert matches_node_name(parts[0], parts[1]) is is_match


def test_values_are_laid_over_one_another_in_their_order(tmp_path: Path) -> None:
    checked = check(
        tmp_path,
        {
            "archgen.yaml": """
archgen: 1
ros: {parameters: {a: ros, b: ros, c: ros, d: ros, use_sim_time: true}}
groups:
  g:
    components:
      c: {title: C, parameters: {b: component, c: component, d: component, set: {e: component}, f: {type: string}}}
nodes:
  n: {implements: c, parameter_files: [one.yaml, two.yaml], parameters: {d: node}, parameter_commands: {set.e: [cat]}}
""",
            "one.yaml": "/**: {ros__parameters: {c: one, d: one, a: one}}\nn: {ros__parameters: {c: later}}",
            "two.yaml": "/**: {ros__parameters: {a: two}}\nother: {ros__parameters: {a: other}}",
        },
    )
    assert effective(checked, "n") == {
        "b": ("component", "component"),
        "c": ("later", "file"),
        "d": ("node", "node"),
        "set.e": (None, "command"),
        "f": (None, "none"),
        "a": ("two", "file"),
        "use_sim_time": (True, "ros"),
    }


def test_a_packed_file_means_what_the_folder_means(tmp_path: Path) -> None:
    checked = check(
        tmp_path,
        {
            "archgen.yaml": PROJECT.replace(
                "nodes: {", "nodes: {m: {implements: c, parameter_files: [a.yaml, b.yaml]}, "
            ),
            # Paths are meant from the file that names them, too: the same words are another file, or none.
            "part/nodes.yaml": "nodes: {o: {implements: c, parameter_files: [a.yaml, b.yaml]}}",
            "part/b.yaml": "/**: {ros__parameters: {gain: 3.0}}",
            "a.yaml": "/**: {ros__parameters: {gain: 1.0}}",
            "part/a.yaml": "/**: {ros__parameters: {gain: 2.0}}",
            "config/a.yaml": "/**: {ros__parameters: {gain: high}}",
        },
    )
    packed = tmp_path / "packed" / "packed.yaml"
    packed.parent.mkdir()
    packed.write_text(pack(checked), encoding="utf-8")
    again = pipeline.check_project(packed)
    for node in "nmo":
        assert effective(again, node) == effective(checked, node)
    assert [f.message for f in again.findings] == [f.message for f in checked.findings]
    assert pack(again) == packed.read_text(encoding="utf-8")


def test_a_comment_in_a_parameter_file_silences_what_is_found_there(tmp_path: Path) -> None:
    text = "/**:\n  ros__parameters:\n    gain: high # archgen: ignore[wrong-parameter] tuned\n"
    assert [f.rule for f in check(tmp_path, {"archgen.yaml": PROJECT, "config/a.yaml": text}).findings] == [
        "missing-detail"
    ]


def test_no_link_is_followed_and_nothing_outside_is_read(tmp_path: Path) -> None:
    (tmp_path / "outside.yaml").write_text("/**: {ros__parameters: {gain: high}}", encoding="utf-8")
    folder = tmp_path / "robot"
    (folder / "config").mkdir(parents=True)
    (folder / "config" / "a.yaml").symlink_to(tmp_path / "outside.yaml")
    (folder / "inside.yaml").write_text("/**: {ros__parameters: {gain: high}}", encoding="utf-8")
    (folder / "config" / "b.yaml").symlink_to(folder / "inside.yaml")
    files = "[config/a.yaml, config/b.yaml, ../outside.yaml, config/../../outside.yaml, config, '']"
    text = f"sources: []\n{PROJECT.replace('[config/a.yaml]', files)}"
    checked = check(folder, {"archgen.yaml": text})
    assert effective(checked, "n") == {"gain": (None, "none")}
    assert [f.rule for f in checked.findings] == ["missing-detail"]


def test_a_missing_file_is_no_finding(tmp_path: Path) -> None:
    assert [f.rule for f in check(tmp_path, {"archgen.yaml": PROJECT}).findings] == ["missing-detail"]


def test_a_file_that_nodes_name_is_not_said_to_be_ignored(tmp_path: Path) -> None:
    files = {"archgen.yaml": PROJECT, "config/a.yaml": "n: {ros__parameters: {gain: 1.0}}", "other.yaml": "x: 1"}
    assert [f.message for f in check(tmp_path, files).findings if f.rule == "ignored-file"] == [
        "`other.yaml` holds no element of the language and is not read"
    ]


def test_what_is_read_is_bounded_and_the_bound_is_said(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(node_parameter_files, "MAX_VALUES", 2)
    text = "/**: {ros__parameters: {gain: 1.0, use_sim_time: true, qos_overrides: {a: 1}}}"
    checked = check(tmp_path, {"archgen.yaml": PROJECT, "config/a.yaml": text})
    assert [f"{f.severity} {f.rule}: {f.message}" for f in checked.findings if f.rule == "too-large"] == [
        "warning too-large: parameter files give more than 2 values to nodes"
    ]


@pytest.mark.parametrize(
    "text",
    [
        "[1, 2]",
        "",
        "a",
        "ros__parameters: {gain: 1.0}",
        "{}",
        "/**: {ros__parameters: 3}",
        "/**: {ros__parameters: {gain: {a: {b: 1}}}}",
        "/**: &a {ros__parameters: *a}",
        "\0",
        "a: {" * 100,
        "/**: {ros__parameters: {<<: 1}}",
        "? [a]\n: 1",
        "/**: {ros__parameters: {" + "x" * 5000 + ": 1}}",
        "///: {ros__parameters: {gain: .nan}}",
        "/**: {ros__parameters: {gain: [[1], {a: b}]}}",
    ],
)
@pytest.mark.parametrize("distro", ["jazzy", "noetic"])
def test_no_file_ends_in_an_exception(tmp_path: Path, text: str, distro: str) -> None:
    project = PROJECT.replace("groups:", f"ros: {{distro: {distro}}}\ngroups:", 1)
    checked = check(tmp_path, {"archgen.yaml": project, "config/a.yaml": text})
    assert effective(checked, "n")


def test_sections_are_those_of_the_name_that_arguments_give_a_node(tmp_path: Path) -> None:
    project = """\
archgen: 1
project: {id: r}
ros: {distro: jazzy}
nodes:
  n: {parameter_files: [p.yaml], arguments: [--ros-args, -r, "__node:=m", -r, "__ns:=/a"]}
"""
    checked = check(
        tmp_path,
        {"archgen.yaml": project, "p.yaml": "/a/m: {ros__parameters: {x: 1}}\n/n: {ros__parameters: {y: 2}}\n"},
    )
    assert effective(checked, "n").keys() == {"x"}
    assert checked.architecture.nodes["n"].full_name == "/a/m"
