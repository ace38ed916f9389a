"""`libraries: {ros: builtin}`: component types that ship with archgen, for the distribution of the project."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import pytest

from archgen import pipeline, resources
from archgen.checking.checked_packing import pack_checked_project
from archgen.diagnostics.diagnostic import Severity
from archgen.diagnostics.source_span import Span
from archgen.link import mapping_values
from archgen.link.shipped_interfaces import load_shipped_interfaces
from archgen.model.known_interfaces import KNOWN_DISTROS
from archgen.model.message_types import full_message_name
from archgen.project import library_reading
from archgen.project.library_reading import load_shipped_component_types, read_shipped_document
from archgen.syntax.yaml_tree import MappingNode, SequenceNode, YamlNode, node_to_data
from tests.property_sizes import try_some
from tests.repositories import repository
from tests.running import ROOT, archgen_here

HEAD = "archgen: 1\nproject: {id: robot, title: Robot}\n"
SMALL = "ros: {distro: jazzy}\nlibraries: {ros: builtin}\ngroups: {g: {components: {it: {is: ros.map_server}}}}\n"


def check(tmp_path: Path, text: str) -> list[str]:
    file = tmp_path / "project.yaml"
    file.write_text(text, encoding="utf-8")
    return [f"{d.rule} {d.span}: {d.message} | {d.help}" for d in pipeline.check_project(file).findings]


def write_instance(distro: str, name: str, body: MappingNode) -> str:
    """Write a project of one instance, with all that it needs coming from outside, and one output read there."""
    ports = [key for key, _, port in mapping_values.iterate_elements(body, "inputs") if "external" not in port.entries]
    inputs = "".join(f"          {port}: {{external: Somebody}}\n" for port in ports)
    outputs = "".join(
        f"        outputs: {{{key}: {{external: Somebody}}}}\n"
        for key, _, _ in [*mapping_values.iterate_elements(body, "outputs")][:1]
    )
    return (
        f"ros: {{distro: {distro}}}\nlibraries: {{ros: builtin}}\ngroups:\n  g:\n    components:\n"
        f"      it:\n        is: ros.{name}{'<std_msgs/msg/String>' if 'generic' in body.entries else ''}\n"
        + (f"        inputs:\n{inputs}" if inputs else "")
        + outputs
    )


_NAMED_BY_EACH_INSTANCE = {"ldlidar", "topic_relay", "topic_throttle"}
"""What these publish has a name that only a parameter of each instance says."""


@pytest.mark.parametrize("distro", try_some(KNOWN_DISTROS, 2))
def test_an_instance_of_each_type_needs_its_inputs_and_the_parameters_that_nobody_can_know(
    distro: str, tmp_path: Path
) -> None:
    file, loud_findings = tmp_path / "project.yaml", {}
    for name, entry in load_shipped_component_types(distro).items():
        file.write_text(write_instance(distro, name, mapping_values.get_body(entry)), encoding="utf-8")
        checked_project = pipeline.check_project(file)
        assert {finding.span.file for finding in checked_project.findings} == {"project.yaml"}, name
        assert checked_project.architecture.nodes["it"].package
        loud_findings[name] = {
            f"{finding.rule}: {finding.message}"
            for finding in checked_project.findings
            if finding.rule not in {"missing-detail", "unset-parameter"}
            and not (finding.rule == "unknown-name" and name in _NAMED_BY_EACH_INSTANCE)
        }
    assert {name: findings for name, findings in loud_findings.items() if findings} == {}


@pytest.mark.parametrize("distro", KNOWN_DISTROS)
def test_each_message_is_held_for_each_distribution_that_has_the_type(distro: str) -> None:
    names = load_shipped_interfaces(distro).names
    missing = {
        f"{name}.{port}: {text}"
        for name, entry in load_shipped_component_types(distro).items()
        for side in ("inputs", "outputs")
        for port, _, body in mapping_values.iterate_elements(mapping_values.get_body(entry), side)
        if mapping_values.get_text(body, "medium") != "physical"
        for text in [mapping_values.get_text(body, "type") or ""]
        if full_message_name(text) not in names
        and text not in mapping_values.get_texts(mapping_values.get_body(entry), "generic")
    }
    assert missing == set()


@pytest.mark.parametrize("distro", KNOWN_DISTROS)
def test_each_type_says_what_it_is_and_where_what_it_sends_goes(distro: str) -> None:
    types = load_shipped_component_types(distro)
    assert len(types) >= (60 if distro in {"noetic", "humble", "jazzy", "kilted"} else 50)
    for name, entry in types.items():
        body = mapping_values.get_body(entry)
        node = mapping_values.get_mapping(body, "node")
        for key in ("title", "functionality"):
            assert mapping_values.get_text(body, key), name
        sent_ports = {
            port
            for port, _, output in mapping_values.iterate_elements(body, "outputs")
            if mapping_values.get_text(output, "medium") != "physical"
        }
        named_ports = {
            key for side in ("publishes", "serves") for key, _, _ in mapping_values.iterate_elements(node, side)
        }
        assert named_ports == sent_ports, name
        assert "parameters" not in body.entries or mapping_values.get_texts(body, "open") == ("*",), name


def test_the_table_of_distributions_names_what_there_is() -> None:
    table = library_reading.read_distribution_table()
    files = {path.name for path in resources.resource_path("ros_library").iterdir()}
    assert files == {*table.files, "distributions.yaml", "sources"}
    packages = {
        mapping_values.get_text(mapping_values.get_mapping(mapping_values.get_body(entry), "node"), "package")
        for file in table.files
        for entry in library_reading.parse_shipped_file(file)
    }
    assert packages == set(table.packages)
    for distro in KNOWN_DISTROS:
        names = [
            entry.key
            for file, distros in table.files.items()
            if distro in distros
            for entry in library_reading.parse_shipped_file(file)
        ]
        assert len(names) == len(set(names)), distro


@pytest.mark.parametrize("distro", try_some(KNOWN_DISTROS, 2))
def test_of_some_packages_all_types_are_found_without_the_rest_of_the_files(distro: str) -> None:
    types = load_shipped_component_types(distro)
    names_by_package: dict[str, set[str]] = {}
    for (package, _), names in library_reading.index_shipped_programs(distro).items():
        names_by_package.setdefault(package, set()).update(names)
    for package, type_names in names_by_package.items():
        found = library_reading.load_package_types(distro, frozenset({package, "nowhere"}))
        assert type_names <= found.keys()
        assert [*found] == [
            name
            for name, entry in types.items()
            if mapping_values.get_text(mapping_values.get_mapping(mapping_values.get_body(entry), "node"), "package")
            == package
        ]
        assert all(node_to_data(entry.value) == node_to_data(types[name].value) for name, entry in found.items())


def test_distributions_differ() -> None:
    assert "move_base" in load_shipped_component_types("noetic")
    assert "move_base" not in load_shipped_component_types("jazzy")
    assert "planner_server" not in load_shipped_component_types("rolling")
    commands = {
        distro: mapping_values.get_text(
            mapping_values.get_mapping(
                mapping_values.get_mapping(
                    mapping_values.get_body(load_shipped_component_types(distro)["controller_server"]), "outputs"
                ),
                "cmd_vel",
            ),
            "type",
        )
        for distro in ("jazzy", "kilted")
    }
    assert commands == {"jazzy": "geometry_msgs/msg/Twist", "kilted": "geometry_msgs/msg/TwistStamped"}


def list_spans(node: YamlNode) -> Iterator[Span]:
    yield node.span
    if isinstance(node, SequenceNode):
        for item in node.items:
            yield from list_spans(item)
    elif isinstance(node, MappingNode):
        for entry in node:
            yield entry.key_span
            yield from list_spans(entry.value)


def test_all_of_it_stands_where_the_project_names_it() -> None:
    span = Span("archgen.yaml", 4, 18, 4, 25)
    document = read_shipped_document("jazzy", span)
    assert set(list_spans(document.root)) == {span}
    other_span = Span("archgen.yaml", 5, 18, 5, 25)
    assert set(list_spans(read_shipped_document("jazzy", other_span).root)) == {other_span}
    assert set(list_spans(document.root)) == {span}


def test_a_type_that_ships_for_other_distributions_is_named_with_them(tmp_path: Path) -> None:
    text = "{head}libraries: {{ros: builtin}}\ngroups: {{g: {{components: {{it: {{is: ros.{name}}}}}}}}}\n"
    assert check(tmp_path, text.format(head="ros: {distro: jazzy}\n", name="gmapping")) == [
        (
            "unknown-reference project.yaml:3:36: no component type named `ros.gmapping` | "
            "it ships for noetic, not for the project's distribution, jazzy"
        )
    ]
    assert check(tmp_path, text.format(head="", name="gmapping")) == [
        (
            "unknown-reference project.yaml:2:36: no component type named `ros.gmapping` | "
            "it ships for noetic, not for jazzy, which counts where `ros.distro` is not written"
        )
    ]
    assert check(tmp_path, text.format(head="ros: {distro: jazzy}\n", name="slam_tolbox")) == [
        "unknown-reference project.yaml:3:36: no component type named `ros.slam_tolbox` | did you mean `ros.slam_toolbox`?"
    ]


def test_a_project_that_has_not_named_the_library_hears_of_it(tmp_path: Path) -> None:
    text = "ros: {{distro: jazzy}}\ngroups: {{g: {{components: {{it: {{is: {name}}}}}}}}}\n"
    help_line = "it ships with archgen: write `libraries: {ros: builtin}` in archgen.yaml"
    assert help_line in check(tmp_path, text.format(name="ros.slam_toolbox"))[0]
    assert help_line not in check(tmp_path, text.format(name="ros.gmapping"))[0]
    assert help_line not in check(tmp_path, text.format(name="other.slam_toolbox"))[0]


def test_a_distribution_for_which_nothing_ships(tmp_path: Path) -> None:
    findings = check(tmp_path, SMALL.replace("jazzy", "foxy"))
    assert next(finding for finding in findings if finding.startswith("missing-library")) == (
        "missing-library project.yaml:2:18: the library `ros` cannot be read from `builtin`: nothing ships for the "
        "distribution `foxy` | component types ship for jazzy, humble, kilted, lyrical, rolling and noetic"
    )
    assert not any(finding.startswith("unknown-reference") for finding in findings)


def test_a_slip_in_the_distribution_is_no_other_one(tmp_path: Path) -> None:
    assert not any(each.startswith("missing-library") for each in check(tmp_path, SMALL.replace("jazzy", "jazy")))


def test_a_folder_called_builtin_is_named_with_a_dot(tmp_path: Path) -> None:
    for name, text in {
        "archgen.yaml": f"{HEAD}libraries: {{ros: ./builtin}}\n",
        "builtin/types.yaml": "component_types: {arm: {outputs: {pose: geometry_msgs/msg/PoseStamped}}}\n",
        "groups.yaml": "groups: {g: {components: {it: {is: ros.arm}}}}\n",
    }.items():
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text(text, encoding="utf-8")
    checked_project = pipeline.check_project(tmp_path)
    assert list(checked_project.architecture.component_types) == ["ros.arm"]
    assert not checked_project.has_errors
    (tmp_path / "archgen.yaml").write_text(f"{HEAD}libraries: {{ros: builtin}}\n", encoding="utf-8")
    assert [d.message for d in pipeline.check_project(tmp_path).findings if d.severity is Severity.ERROR] == [
        "no component type named `ros.arm`"
    ]


def test_only_archgen_yaml_names_it(tmp_path: Path) -> None:
    (tmp_path / "archgen.yaml").write_text(HEAD, encoding="utf-8")
    (tmp_path / "a.yaml").write_text(SMALL, encoding="utf-8")
    assert [str(d.span) for d in pipeline.check_project(tmp_path).findings if d.rule == "missing-library"] == [
        "a.yaml:2:18"
    ]


def test_a_commit_has_it_too(tmp_path: Path) -> None:
    repository(tmp_path, {"archgen.yaml": HEAD + SMALL})
    disk, committed = pipeline.check_project(tmp_path), pipeline.check_at_revision(tmp_path, "HEAD")
    assert committed.architecture == disk.architecture
    assert list(committed.architecture.component_types) == ["ros.map_server"]


def test_a_packed_file_holds_what_is_used_and_asks_archgen_for_nothing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    file = tmp_path / "project.yaml"
    file.write_text(SMALL, encoding="utf-8")
    checked_project = pipeline.check_project(file)
    packed_data = pack_checked_project(checked_project).data
    assert list(packed_data["libraries"]["ros"]) == ["component_types"]  # type: ignore[index]
    assert list(packed_data["libraries"]["ros"]["component_types"]) == ["map_server"]  # type: ignore[index]

    def refuse(*_: object) -> None:
        raise AssertionError

    monkeypatch.setattr("archgen.project.library_reading.read_shipped_document", refuse)
    import yaml

    file.write_text(yaml.safe_dump(packed_data, sort_keys=False), encoding="utf-8")
    packed_project = pipeline.check_project(file)
    assert not packed_project.has_errors
    assert packed_project.architecture.nodes == checked_project.architecture.nodes
    assert packed_project.architecture.component_types == checked_project.architecture.component_types


def test_a_project_without_it_reads_nothing_of_it(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def refuse(*_: object) -> None:
        raise AssertionError

    monkeypatch.setattr(library_reading, "read_distribution_table", refuse)
    monkeypatch.setattr(library_reading, "parse_shipped_file", refuse)
    assert check(tmp_path, "groups: {g: {components: {it: {is: that}}}}\ncomponent_types: {that: {title: That}}\n")


def test_findings_stand_at_the_component_and_a_comment_there_silences_them(tmp_path: Path) -> None:
    text = (
        "ros: {distro: jazzy}\nlibraries: {ros: builtin}\ngroups:\n  g:\n    components:\n"
        "      one: {is: ros.amcl, inputs: {map: two.map}}\n      two: {is: ros.map_server, parameters: {yaml_filename: m.yaml}}\n"
    )
    assert [finding for finding in check(tmp_path, text) if not finding.startswith("missing-detail")] == [
        (
            "unfed-input project.yaml:6:7: nothing feeds the input `scan` of `g.one` | name its source in `from`, say what feeds it "
            "from outside in `external`, or write `optional: true`"
        )
    ]
    silenced = text.replace("two.map}}", "two.map}}  # archgen: ignore[unfed-input] the scanner comes later")
    assert [finding for finding in check(tmp_path, silenced) if not finding.startswith("missing-detail")] == []


def test_a_type_of_the_project_is_made_from_one_that_ships(tmp_path: Path) -> None:
    text = (
        "ros: {distro: jazzy}\nlibraries: {ros: builtin}\n"
        "component_types:\n  recorder: {is: ros.rosbag_recorder, inputs: {map: nav_msgs/msg/OccupancyGrid}}\n"
        "groups:\n  g:\n    components:\n"
        "      map: {is: ros.map_server, parameters: {yaml_filename: m.yaml}}\n"
        "      bag: {is: recorder, inputs: {map: map.map}}\n"
    )
    assert [finding for finding in check(tmp_path, text) if not finding.startswith("missing-detail")] == []


def test_the_pages_of_the_library_are_fresh() -> None:
    import importlib.util

    path = ROOT / "tools" / "make_ros_library_page.py"
    spec = importlib.util.spec_from_file_location("make_ros_library_page", path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    for page, format_page in module.PAGES.items():
        assert page.read_text(encoding="utf-8") == format_page(), "run tools/make_ros_library_page.py"


def test_programs_are_known_by_what_they_call_their_nodes() -> None:
    assert library_reading.find_program_name("ros_gz_bridge", "parameter_bridge") == "ros_gz_bridge"
    assert library_reading.find_program_name("image_proc", "image_proc::RectifyNode") == "RectifyNode"
    for program in ("static_transform_publisher", "unheard_of", ""):
        assert not library_reading.find_program_name("tf2_ros", program)


def test_it_may_have_any_name_and_more_than_one(tmp_path: Path) -> None:
    text = (
        "ros: {distro: jazzy}\nlibraries: {a: builtin, b: {path: builtin}}\ngroups:\n  g:\n    components:\n"
        "      one: {is: a.rplidar}\n      two: {is: b.amcl, inputs: {scan: one.scan, map: three.map}}\n"
        "      three: {is: b.map_server, parameters: {yaml_filename: m.yaml}}\n"
    )
    assert {finding.partition(" ")[0] for finding in check(tmp_path, text)} == {"missing-detail"}


def test_what_is_no_path_is_refused_as_any_other(tmp_path: Path) -> None:
    for path in ("Builtin", "builtin/", "' builtin'", "[builtin]", "null", "1"):
        text = f"libraries: {{ros: {path}}}\ngroups: {{g: {{components: {{it: {{is: ros.amcl}}}}}}}}\n"
        assert check(tmp_path, text), path


@pytest.mark.parametrize(
    ("own_node", "status"),
    [
        ("{package: my_camera}", None),
        ("{package: my_camera, status: existing}", "existing"),
        ("{package: v4l2_camera}", "existing"),
        ("{parameters: {brightness: 3}}", "existing"),
    ],
)
def test_a_program_in_a_package_of_ones_own_is_not_said_to_exist(
    own_node: str, status: str | None, tmp_path: Path
) -> None:
    for form in (
        f"groups: {{g: {{components: {{camera: {{is: ros.v4l2_camera, node: {own_node}}}}}}}}}\n",
        f"component_types: {{mine: {{is: ros.v4l2_camera, node: {own_node}}}}}\ngroups: {{g: {{components: {{camera: {{is: mine}}}}}}}}\n",
    ):
        file = tmp_path / "project.yaml"
        file.write_text(f"ros: {{distro: jazzy}}\nlibraries: {{ros: builtin}}\n{form}")
        packed = tmp_path / "packed.yaml"
        archgen_here("pack", file, "-o", packed, cwd=tmp_path, status=0)
        for each in (file, packed):
            architecture = pipeline.check_project(each).architecture
            assert architecture.nodes["camera"].status == status
            if "status" not in own_node:
                assert architecture.components["g.camera"].status == status
