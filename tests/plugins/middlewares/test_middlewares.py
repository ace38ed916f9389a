"""The backends `orocos`, `openrtm` and `player`: the rules and table 5 of the paper, names, values and wiring."""

from __future__ import annotations

import re
from pathlib import Path
from xml.etree import ElementTree as ET

import pytest
import yaml

from archgen.products.output_options import OutputOptions
from archgen.products.workspace_product import WorkspaceRequest, write_workspace
from tests.hostile import TEXTS
from tests.judged_projects import judge_shipped
from tests.outside_tools import find_tool, run_judge
from tests.plugins.middlewares.idl_stand_in import write_skeleton
from tests.plugins.middlewares.middleware_projects import (
    HEADLAMP,
    ODD,
    STAND_INS,
    compile_cpp,
    generate,
    write_project,
)
from tests.plugins.middlewares.player_configuration import read_configuration
from tests.plugins.middlewares.simulation.random_robots import make_robot
from tests.property_sizes import try_some
from tests.running import ROOT, contents

MIDDLEWARES = ("orocos", "openrtm", "player")
PAGE = (ROOT / "docs" / "middlewares.md").read_text(encoding="utf-8")
ROWS = {
    "R1": {
        "orocos": [("src/library.cpp", "ORO_LIST_COMPONENT_TYPE(headlamp::Guppy80)"), ("include/headlamp/guppy_80.hpp", "class Guppy80 : public RTT::TaskContext")],
        "openrtm": [("profiles/guppy_80.xml", 'rtc:name="Guppy80"'), ("include/headlamp/guppy_80.hpp", "class Guppy80 : public RTC::DataFlowComponentBase"), ("src/guppy_80.cpp", '"implementation_id", "Guppy80"')],
        "player": [("src/plugin.cpp", 'AddDriver("headlamp_guppy_80", make_driver<headlamp::Guppy80>)'), ("include/headlamp/guppy_80.hpp", "class Guppy80 : public ThreadedDriver")],
    },
    "R2 ports": {
        "orocos": [("include/headlamp/four_point.hpp", "RTT::InputPort<headlamp::headlamp_msgs::Image> image_input_;"), ("include/headlamp/four_point.hpp", "RTT::OutputPort<headlamp::headlamp_msgs::Position> position_output_;")],
        "openrtm": [("include/headlamp/four_point.hpp", "RTC::InPort<headlamp::timed::headlamp_msgs_Image> image_input_;"), ("include/headlamp/four_point.hpp", "RTC::OutPort<headlamp::timed::headlamp_msgs_Position> position_output_;")],
        "player": [("vision_pc.cfg", 'provides ["position:::opaque:6" "get_position:::opaque:7" "find_all:::opaque:8"]'), ("vision_pc.cfg", 'requires ["image_0:::opaque:0"]')],
    },
    "R2 wiring": {
        "orocos": [("deployment/vision_pc.cpf", '<struct name="assembly_camera.image.assembly_pos_sensor.image" type="ConnPolicy">'), ("deployment/vision_pc.lua", 'connect("assembly_camera.image", "assembly_pos_sensor.image", 0, 0, false)')],
        "openrtm": [("vision_pc.rtc.conf", "assembly_camera.image?port=assembly_pos_sensor.image&"), ("system.xml", 'rts:connectorId="assembly_camera.image.assembly_pos_sensor.image"')],
        "player": [("robot_pc.cfg", '"position_0:vision_pc:6665:opaque:6"')],
    },
    "R3 get": {
        "orocos": [("src/guppy_80.cpp", 'addOperation("get_image", &Guppy80Behaviour::serve_get_image'), ("include/headlamp/guppy_80_behaviour.hpp", "headlamp::headlamp_msgs::Image serve_get_image();")],
        "openrtm": [("idl/headlamp.idl", "::headlamp::headlamp_msgs::Image get_image();"), ("src/guppy_80.cpp", 'registerProvider("operations"')],
        "player": [("src/guppy_80.cpp", "PLAYER_MSGTYPE_REQ, PLAYER_OPAQUE_REQ_DATA, get_image_operation_"), ("include/headlamp/guppy_80_behaviour.hpp", "serve_get_image();")],
    },
    "R3 set": {
        "orocos": [("src/guppy_80.cpp", 'addOperation("set_exposure", &Guppy80Behaviour::execute_set_exposure, behaviour_.get(), RTT::OwnThread)')],
        "openrtm": [("idl/headlamp.idl", "oneway void set_exposure(in double exposure);")],
        "player": [("src/guppy_80.cpp", "PLAYER_MSGTYPE_CMD, PLAYER_OPAQUE_CMD_DATA, set_exposure_operation_"), ("include/headlamp/guppy_80_behaviour.hpp", "void execute_set_exposure(double exposure);")],
    },
    "R4": {
        "orocos": [("src/guppy_80.cpp", 'addProperty("exposure", parameters_.exposure)'), ("config/assembly_spare_camera.cpf", '<simple name="exposure" type="double"><value>0.01</value></simple>')],
        "openrtm": [("src/guppy_80.cpp", 'bindParameter("exposure", parameters_.exposure, "0.02", values::read)'), ("config/assembly_spare_camera.conf", "conf.default.exposure: 0.01")],
        "player": [("include/headlamp/guppy_80.hpp", "DoubleProperty exposure_property_;"), ("vision_pc.cfg", 'exposure "0.01"')],
    },
    "R5 periodic": {
        "orocos": [("deployment/robot_pc.cpf", '<simple name="Period" type="double"><value>0.01</value></simple>'), ("src/guppy_80.cpp", "behaviour_->step();")],
        "openrtm": [("config/assembly_force_sensor.conf", "exec_cxt.periodic.rate: 100.0"), ("profiles/assembly_force_sensor.xml", 'rtc:executionRate="100.0"')],
        "player": [("robot_pc.cfg", 'period "0.01"')],
    },
    "R5 not periodic": {
        "orocos": [("src/four_point.cpp", "addEventPort(image_input_)"), ("deployment/vision_pc.lua", 'load("assembly_pos_sensor", "headlamp::FourPoint", 0.0,')],
        "openrtm": [("src/four_point.cpp", "if (has_news) {"), ("profiles/four_point.xml", 'rtc:activityType="EVENTDRIVEN"')],
        "player": [("src/four_point.cpp", "Wait(is_complete ? 0.0 : 0.5);")],
    },
    "states": {
        "orocos": [("src/guppy_80.cpp", f"{each}Hook()") for each in ("configure", "start", "update", "stop", "cleanup")],
        "openrtm": [("src/guppy_80.cpp", each) for each in ("::onInitialize()", "::onActivated(", "::onExecute(", "::onDeactivated(", "::onFinalize()")],
        "player": [("src/guppy_80.cpp", each) for each in ("::MainSetup()", "::Main()", "::MainQuit()")],
    },
    "shared or buffered": {
        "orocos": [("deployment/robot_pc.lua", '"assembly_controller.force", 2, 5, false)'), ("deployment/robot_pc.lua", '"assembly_controller.words", 1, 1000, true)')],
        "openrtm": [("robot_pc.rtc.conf", "assembly_controller.force&interface_type=corba_cdr&dataflow_type=push&subscription_type=new&push_policy=all&inport.buffer.length=5&inport.buffer.write.full_policy=overwrite")],
        "player": [("src/assembly_controller.cpp", "ThreadedDriver(configuration, section, false, PLAYER_MSGQUEUE_DEFAULT_MAXLEN)")],
    },
}  # fmt: skip
"""What each row of the page says, for each middleware: files and what stands in them."""


HEADLAMP_CLASSES = ["four_point", "guppy_80", "impedance", "manipulator", "wrist_sensor"]


@pytest.fixture(scope="module")
def headlamp(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """Return a workspace with all three."""
    folder = tmp_path_factory.mktemp("headlamp")
    project = write_project(folder / "p", HEADLAMP)
    for middleware in MIDDLEWARES:
        assert generate(project, folder / "w", middleware) == []
    return folder / "w"


@pytest.mark.parametrize("row", ROWS)
@pytest.mark.parametrize("middleware", MIDDLEWARES)
def test_a_row_of_the_tables(row: str, middleware: str, headlamp: Path) -> None:
    for path, words in ROWS[row][middleware]:
        assert words in (headlamp / middleware / path).read_text("utf-8"), path
    assert f"| {row} |" in PAGE


def test_the_page_has_no_other_rows() -> None:
    rows = re.findall(
        r"^\| ([^|]+?) \|.*\|.*\|.*\|$", PAGE.partition("## What becomes of what")[2].partition("##")[0], re.MULTILINE
    )
    assert rows[1:] == list(ROWS)


def test_the_case_of_the_paper_goes_from_uml_to_code(tmp_path: Path) -> None:
    """`archgen import xmi` made the project; all three make its five components."""
    project = judge_shipped(ROOT / "examples" / "headlamp")
    for middleware in MIDDLEWARES:
        assert generate(project, tmp_path, middleware) == []
        own = sorted(each.name for each in (tmp_path / middleware / "src").glob("*_behaviour.cpp"))
        assert own == [f"{each}_behaviour.cpp" for each in HEADLAMP_CLASSES]
    _read_all(tmp_path)
    code = (tmp_path / "orocos" / "src" / "guppy_80.cpp").read_text("utf-8")
    assert 'addOperation("get_image", &Guppy80Behaviour::serve_get_image' in code
    assert 'addOperation("set_exposure", &Guppy80Behaviour::execute_set_exposure' in code
    assert 'addProperty("gain", parameters_.gain)' in code
    assert any(
        'name="Period" type="double"><value>0.04<' in each.read_text("utf-8")
        for each in tmp_path.glob("orocos/deployment/*.cpf")
    )


def test_private_operations_and_protected_parameters_stay_inside(headlamp: Path) -> None:
    for text in contents(headlamp).values():
        assert b"calibrate" not in text
        assert b"hidden" not in text


def test_all_files_can_be_read(headlamp: Path) -> None:
    for middleware in MIDDLEWARES:
        _read_all(headlamp / middleware)


def _read_all(folder: Path) -> None:
    """Let a parser read each file that has one in Python."""
    for path in sorted(each for each in folder.rglob("*") if each.is_file()):
        text = path.read_text("utf-8")
        if path.suffix in {".xml", ".cpf"}:
            ET.fromstring(text)  # noqa: S314 - just made
        elif path.suffix == ".cfg":
            read_configuration(text)
        elif path.suffix == ".idl":
            write_skeleton(text)
        elif path.suffix == ".conf":
            for line in text.splitlines():
                assert re.match(r"#|[\w.]+: ?", line) or not line, line
        elif path.suffix == ".lua":
            _read_lua(path)


def _read_lua(path: Path) -> None:
    text = re.sub(r'--[^\n]*|"[^"\n\\]*"', "", path.read_text("utf-8"))
    assert '"' not in text
    assert text.count("(") == text.count(")")
    # What ends a block: each function, loop, `if` and `then` that begins one.
    assert len(re.findall(r"\b(?:function|for|if)\b", text)) == len(re.findall(r"\bend\b", text))


def compile_middleware(workspace: Path, middleware: str, folder: Path) -> str:
    """Return what the compiler says of all C++ that a backend wrote."""
    stand_ins = [STAND_INS / middleware]
    for idl in workspace.glob("openrtm/idl/*.idl"):
        (folder / f"{idl.stem}Skel.h").write_text(write_skeleton(idl.read_text("utf-8")), "utf-8")
        stand_ins.append(folder)
    files = sorted((workspace / middleware / "src").glob("*.cpp"))
    assert files
    return compile_cpp(files, [workspace / middleware / "include"], stand_ins, folder / f"{middleware}.cpp")


def make_hostile_text(text: str) -> str:
    """Return a project of which each text is this one."""
    component = {
        "title": text,
        "functionality": text,
        "inputs": {"i": {"type": "T", "external": text, "description": text}},
        "outputs": {"o": {"type": "T", "description": text}},
        "operations": {"set_it": {"description": text, "request": {"a": "float64"}}},
        "parameters": {"x": {"value": text, "description": text, "unit": text}, "y": {"value": ["a", text]}},
    }
    project = {
        "archgen": 1,
        "project": {"id": "p", "title": text},
        "groups": {"g": {"components": {"a": component}}},
        "types": {"T": {"comment": text, "fields": {"x": {"type": "float64", "comment": text}}}},
        "hosts": {"h": {"title": text}},
        "nodes": {"a": {"implements": "a", "host": "h", "title": text}},
    }
    return yaml.safe_dump(project, allow_unicode=True)


@pytest.mark.build
@pytest.mark.parametrize("middleware", MIDDLEWARES)
def test_the_headlamp_compiles(middleware: str, headlamp: Path, tmp_path: Path) -> None:
    assert compile_middleware(headlamp, middleware, tmp_path) == ""


@pytest.mark.build
@pytest.mark.parametrize("middleware", MIDDLEWARES)
@pytest.mark.parametrize(
    "example",
    ["examples/headlamp", "examples/cleaning_robot", "examples/arm", "examples/vehicle/scenario", "example_ramcip"],
)
def test_examples_compile(example: str, middleware: str, tmp_path: Path) -> None:
    generate(judge_shipped(ROOT / example), tmp_path / "w", middleware)
    _read_all(tmp_path / "w")
    assert compile_middleware(tmp_path / "w", middleware, tmp_path) == ""


@pytest.mark.parametrize("seed", try_some(range(3), 1))
def test_random_robots_have_files_that_can_be_read(seed: int, tmp_path: Path) -> None:
    project = write_project(tmp_path / "p", make_robot(seed).text)
    for middleware in MIDDLEWARES:
        assert generate(project, tmp_path / "w", middleware) == []
    _read_all(tmp_path / "w")


ODD_LEFT_OUT = ["`auto.void a.b` and `auto.void a.B` give the same parameter `aB`"]


@pytest.mark.parametrize("middleware", MIDDLEWARES)
def test_odd_names_are_names(middleware: str, tmp_path: Path) -> None:
    assert generate(write_project(tmp_path / "p", ODD), tmp_path / "w", middleware) == ODD_LEFT_OUT
    _read_all(tmp_path / "w")


@pytest.mark.build
@pytest.mark.parametrize("middleware", MIDDLEWARES)
def test_odd_names_compile(middleware: str, tmp_path: Path) -> None:
    generate(write_project(tmp_path / "p", ODD), tmp_path / "w", middleware)
    assert compile_middleware(tmp_path / "w", middleware, tmp_path) == ""


@pytest.mark.parametrize("text", [HEADLAMP, ODD, *(make_hostile_text(each) for each in TEXTS.values())])
def test_lua_reads_its_files(text: str, tmp_path: Path) -> None:
    generate(write_project(tmp_path / "p", text), tmp_path / "w", "orocos")
    files = sorted((tmp_path / "w").rglob("*.lua"))
    assert files
    for file in files:
        run_judge(find_tool("luac5.1"), "-p", file)


@pytest.mark.parametrize("middleware", MIDDLEWARES)
@pytest.mark.parametrize("kind", TEXTS)
def test_hostile_texts_end_nothing(middleware: str, kind: str, tmp_path: Path) -> None:
    generate(write_project(tmp_path / "p", make_hostile_text(TEXTS[kind])), tmp_path / "w", middleware)
    _read_all(tmp_path / "w")
    files = [*(tmp_path / "w").rglob("*.cpp"), *(tmp_path / "w").rglob("*.hpp")]
    assert len(files) >= 6
    for path in files:
        code = path.read_text("utf-8")
        bare = re.sub(r'"(?:[^"\\\n]|\\.)*"|//[^\n]*|#include <[^>]*>', "", code)
        assert not re.search(r"[\x00-\x09\x0b-\x1f\x7f-\x9f\u2028\u2029\u202a-\u202e\u2066-\u2069]", code), path
        assert '"' not in bare, path
        assert not set(re.findall(r"\w+", bare)) & {"alert", "cmd", "script", "rm", "w" * 50}, path
        assert "*/" not in re.sub(r"/\*\w+\*/", "", bare), path


@pytest.mark.parametrize(
    ("backend", "value", "told"),
    [
        ("orocos", "'a\\nb'", "it has a line break or a control character"),
        ("openrtm", "'a\\nb'", "it has a line break or a control character"),
        ("openrtm", "[a, 'b,c']", "it is a list of texts with commas"),
        ("openrtm", "' a'", "it has blanks at its ends"),
        ("player", "'a \"b\"'", "it has a double quote"),
        ("player", "w" * 1000, "it has more than 900 bytes"),
    ],
)
def test_values_that_a_file_cannot_hold_are_told(backend: str, value: str, told: str, tmp_path: Path) -> None:
    value = value.replace("'a\\nb'", '"a\\nb"')
    text = f"archgen: 1\ngroups: {{g: {{components: {{a: {{outputs: {{}}, parameters: {{x: {value}, y: 2}}}}}}}}}}\n"
    (message,) = generate(write_project(tmp_path / "p", text), tmp_path / "w", backend)
    assert message.startswith("the value of `x` of `g.a` is left out: ")
    assert told in message
    assert any(
        b"y" in data for path, data in contents(tmp_path / "w").items() if path.endswith((".cpf", ".conf", ".cfg"))
    )


HINTED = """\
archgen: 1
project: {id: p}
types:
  Frame: {hints: {orocos: {type: 'KDL::Frame', header: kdl/frames.hpp, typekit: kdl_typekit}, openrtm: {type: 'RTC::TimedPose2D'}, player: {interface: position2d}}}
  Bad: {hints: {orocos: {type: 'X; evil()'}, openrtm: {type: 'X y'}, player: {interface: nothing}}}
groups:
  g:
    components:
      a: {inputs: {}, outputs: {frame: Frame, bad: Bad}}
      b: {inputs: {frame: a.frame, bad: a.bad, order: {type: Frame, external: Somebody}}, outputs: {}}
"""


def test_types_of_others_are_named_by_hints(tmp_path: Path) -> None:
    project = write_project(tmp_path / "p", HINTED)
    left_out = {each: generate(project, tmp_path / "w", each) for each in MIDDLEWARES}
    assert left_out["orocos"] == left_out["openrtm"] == ["the hint `type` is no class of C++"]
    assert left_out["player"] == ["`nothing` is no interface of Player with data"]
    files = {path: data.decode() for path, data in contents(tmp_path / "w").items()}
    header = files["orocos/include/p/g_b.hpp"]
    assert "#include <kdl/frames.hpp>" in header
    assert "RTT::InputPort<KDL::Frame> frame_input_;" in header
    assert "<value>kdl_typekit</value>" in files["orocos/deployment/no_host.cpf"]
    assert "RTC::InPort<RTC::TimedPose2D> frame_input_;" in files["openrtm/include/p/g_b.hpp"]
    assert "void receive_frame(const player_position2d_data_t & value);" in files["player/include/p/g_b_behaviour.hpp"]
    assert (
        "void receive_order(const player_position2d_cmd_vel_t & value);" in files["player/include/p/g_b_behaviour.hpp"]
    )
    assert 'requires ["frame_0:::position2d:0" "bad_0:::opaque:0"]' in files["player/no_host.cfg"]
    assert not any("evil" in text for text in files.values())


def test_types_of_others_compile(tmp_path: Path) -> None:
    generate(write_project(tmp_path / "p", HINTED), tmp_path / "w", "player")
    assert compile_middleware(tmp_path / "w", "player", tmp_path) == ""


def test_the_example_of_the_page(tmp_path: Path) -> None:
    (example,) = re.findall(r"```yaml\n(types:.*?)```", PAGE, re.DOTALL)
    text = (
        "archgen: 1\nproject: {id: p}\ngroups: {g: {components: {a: {outputs: {at: Position}}, b: {inputs: {at: a.at}, outputs: {}}}}}\n"
        f"{example}nodes: {{a: {{implements: g.a, host: arm_pc}}}}\n"
    )
    project = write_project(tmp_path / "p", text)
    for middleware in MIDDLEWARES:
        assert generate(project, tmp_path / "w", middleware) == []
    files = {path: data.decode() for path, data in contents(tmp_path / "w").items()}
    assert "RTT::OutputPort<KDL::Frame> at_output_;" in files["orocos/include/p/g_a.hpp"]
    assert "RTC::OutPort<RTC::TimedPose2D> at_output_;" in files["openrtm/include/p/g_a.hpp"]
    assert 'provides ["at:::position2d:0"]' in files["player/arm_pc.cfg"]
    assert 'requires ["at_0:10.0.0.2:6665:position2d:0"]' in files["player/no_host.cfg"]


def test_an_interface_without_commands_is_not_commanded(tmp_path: Path) -> None:
    text = (
        "archgen: 1\ntypes: {Scan: {hints: {player: {interface: laser}}}, Say: {hints: {player: {interface: speech}}}}\n"
        "groups: {g: {components: {a: {inputs: {scan: {type: Scan, external: Somebody}}, outputs: {say: Say}}}}}\n"
    )
    assert generate(write_project(tmp_path / "p", text), tmp_path / "w", "player") == [
        "`laser` of Player is not used for `g.a.scan`: it has no commands, and nobody of the architecture feeds it",
        "`speech` of Player is not used for `g.a.say`: it has no data",
    ]


def test_an_input_of_two_types_is_two_ports(tmp_path: Path) -> None:
    text = """\
archgen: 1
types: {A: {fields: {x: {type: int8}}}, B: {fields: {y: {type: int8}}}}
groups: {g: {components: {a: {outputs: {one: A}}, b: {outputs: {two: B}}, c: {inputs: {both: [a.one, b.two]}}}}}
"""
    assert generate(write_project(tmp_path / "p", text), tmp_path / "w", "orocos") == []
    script = (tmp_path / "w" / "orocos" / "deployment" / "no_host.lua").read_text("utf-8")
    assert 'connect("g_a.one", "g_c.both", 0, 0, false)' in script
    assert 'connect("g_b.two", "g_c.both_two", 0, 0, false)' in script


def test_a_service_that_nobody_answers_is_told(tmp_path: Path) -> None:
    text = (
        "archgen: 1\ntypes: {Ask: {message: p_msgs/srv/Ask, request: {a: {type: int8}}, response: {b: {type: int8}}}}\n"
        "groups: {g: {components: {a: {inputs: {ask: {type: Ask, external: Somebody}}}}}}\n"
    )
    assert generate(write_project(tmp_path / "p", text), tmp_path / "w", "orocos") == [
        "`g.a.ask` is left out: nobody of the architecture answers it"
    ]


@pytest.mark.parametrize("middleware", MIDDLEWARES)
def test_own_code_is_kept_and_asked_for_what_the_model_gained(middleware: str, tmp_path: Path) -> None:
    project = write_project(tmp_path / "p", HEADLAMP)
    generate(project, tmp_path / "w", middleware)
    own = tmp_path / "w" / middleware / "src" / "four_point_behaviour.cpp"
    own.write_text(own.read_text("utf-8").replace("receive_image", "take_picture"), "utf-8")
    result = write_workspace(project, OutputOptions(), middleware, tmp_path / "w")
    assert result.plan is not None
    assert "take_picture" in own.read_text("utf-8")
    (step,) = (each for each in result.plan.steps if each.path.endswith("four_point_behaviour.cpp"))
    assert "receive_image" in str(step)


@pytest.mark.parametrize("middleware", MIDDLEWARES)
def test_a_part_has_the_names_and_wires_of_the_whole(middleware: str, tmp_path: Path) -> None:
    project = write_project(tmp_path / "p", HEADLAMP)
    generate(project, tmp_path / "whole", middleware)
    generate(project, tmp_path / "part", middleware, WorkspaceRequest(host="vision_pc"))
    whole, part = contents(tmp_path / "whole"), contents(tmp_path / "part")
    names = {path for path in part if "vision_pc" in path or "four_point" in path or "guppy_80" in path}
    assert any("vision_pc" in each for each in names)
    assert not any("robot_pc" in path or "controller" in path for path in part)
    for path in names:
        assert part[path] == whole[path], path


def test_names_of_two_files_that_would_be_one_are_told(tmp_path: Path) -> None:
    text = "archgen: 1\ngroups: {g: {components: {arm_1: {parameters: {x: 1}, outputs: {}}, arm1: {parameters: {x: 1}, outputs: {}}}}}\n"
    assert generate(write_project(tmp_path / "p", text), tmp_path / "w", "orocos") == [
        "`g.arm_1` and `g.arm1` give the same class `GArm1`"
    ]
