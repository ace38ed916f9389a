"""The backends `ros2_launch` and `ros1_launch`: ROS knows every word, the plan's steps stand there in its order, texts stay texts."""

from __future__ import annotations

import json
import shlex
import subprocess
from pathlib import Path
from xml.etree import ElementTree as ET

import pytest
import yaml

from archgen.bringup.plan_shapes import StartPlan
from archgen.bringup.start_plan import make_start_plan
from tests import hostile
from tests.judged_projects import judge_shipped
from tests.plugins.ros_code.launch.launch_reading import (
    make_launch_workspace,
    read_launch_file,
    read_literal_2,
    read_text_1,
    read_text_2,
    read_words_1,
)
from tests.plugins.start_scripts.start_up.started_workspaces import check_by_shellcheck
from tests.running import RAMCIP, ROOT

EXAMPLES = {
    "courier": ROOT / "examples" / "bringup",
    "cleaning": ROOT / "examples" / "cleaning_robot",
    "ramcip": RAMCIP,
    "vehicle": ROOT / "examples" / "vehicle" / "scenario",
}
WORDS = [
    *(
        "$(env HOME)",
        "$(command 'touch trace')",
        "$",
        "$$(",
        "\\$(",
        "\\",
        "a\\nb \\",
        "`touch trace`",
        "'; touch trace; '",
    ),
    *(
        '"',
        "-->",
        "<!--",
        "]]>",
        "&amp;",
        "<node/>",
        "line\nbreak",
        "\ttab ",
        "$(eval 1)",
        "__x__",
        "ü 漢字 😀",
        "--",
        "",
        "{{ x }}",
    ),
]
SIMPLE = """\
archgen: 1
project: {id: bot, title: "Bot -- <&> $(env HOME)"}
ros: {distro: DISTRO, parameters: {use_sim_time: true}}
groups:
  g:
    components:
      cam:
        outputs: {image: sensor_msgs/msg/Image}
        parameters: {rate: {type: float, value: 10}, text: {value: "yes"}, list: {value: [a, "1"]}}
      det:
        inputs: {image: cam.image}
        outputs: {pose: geometry_msgs/msg/Pose}
        parameters: {robot_description: {type: string}, size: {type: integer, value: 1}}
nodes:
  cam:
    implements: cam
    status: existing
    package: cams
    executable: cam
    namespace: front
    host: pc
    publishes: {image: {topic: /image, own_name: raw}}
    remaps: {/tf: tf}
    arguments: ARGUMENTS
    parameters: {rate: 20, a.b: 1, a.c: true, text: "$(eval 1) \\\\ 'x'", map: "$(find-pkg-share maps)/$(env HOUSE).yaml", port: "$(env PORT)"}
    parameter_files: ["$(find-pkg-share cams)/more.yaml", /etc/cam.yaml, "~/cam.yaml"]
    start: {environment: {HOSTILE: ENVIRONMENT}, directory: "/d $(env X)", user: robot, respawn: true, respawn_delay: 2 s}
  det:
    implements: det
    kind: KIND
    container: box
    parameter_commands: {robot_description: [xacro, "it's $(env HOME) \\\\"]}
  stage: {kind: program, host: pc, command: ARGUMENTS, start: {phase: simulators}}
  other: {status: existing}
containers: {box: {host: pc, namespace: /front, threads: 2, parameters: {beat: 1}}}
hosts: {pc: {}}
"""


def write_simple(folder: Path, distro: str) -> Path:
    """Write a project whose words try to be more than words."""
    kind = "nodelet" if distro == "noetic" else "composable"
    text = SIMPLE.replace("DISTRO", distro).replace("KIND", kind)
    text = text.replace("ARGUMENTS", json.dumps(["prog", *WORDS], ensure_ascii=False)).replace(
        "ENVIRONMENT", json.dumps(" ".join(WORDS), ensure_ascii=False)
    )
    if distro == "noetic":
        text = text.replace("/msg/", "/")
    folder.mkdir()
    (folder / "archgen.yaml").write_text(text, encoding="utf-8")
    return folder


def list_launched(file: Path, ros: int, names: dict[str, str]) -> list[str]:
    """Return the steps that a host's launch file starts, in its order, by what they are called there."""
    found = []
    for element in read_launch_file(file, ros).iter():
        if element.tag in {"node", "node_container", "composable_node"}:
            namespace = element.get("namespace") or element.get("ns") or "/"
            found.append(f"{namespace.rstrip('/')}/{element.get('name')}")
        elif element.tag == "executable" and element.get("name") != "set_states":
            found.append(str(element.get("name")))
    return [names[name] for name in found]


@pytest.mark.parametrize("name", EXAMPLES)
def test_each_computer_starts_what_the_plan_says_in_its_order(name: str, tmp_path: Path) -> None:
    architecture = judge_shipped(EXAMPLES[name]).architecture
    plan: StartPlan = make_start_plan(architecture)
    package, left_out = make_launch_workspace(EXAMPLES[name], tmp_path / "ws", "ros2_launch")
    assert left_out == []
    names = {step.ros.full_name if step.ros else step.file_name: step.id for step in plan.steps}
    hosts = {step.host or "no-host" for step in plan.steps}
    files = {file.name.removesuffix(".launch.xml"): file for file in (package / "launch" / "hosts").iterdir()}
    assert set(files) == hosts
    for host, file in files.items():
        steps = [step for step in plan.steps if (step.host or "no-host") == host]
        # What nobody says how to start is in the file as a comment, unless it is generated.
        nobody = {
            step.id for step in steps if not step.command and (step.status == "existing" or step.kind == "program")
        }
        assert list_launched(file, 2, names) == [step.id for step in steps if step.id not in nobody]
        text = file.read_text(encoding="utf-8")
        assert text.count("not started here") == len(nobody)
        phases = [line.split()[2] for line in text.splitlines() if line.strip().startswith("<!-- Phase:")]
        assert phases == list(dict.fromkeys(step.phase for step in steps))
        called = [
            read_literal_2(str(each.get("cmd")).partition("set_states")[2])
            for each in read_launch_file(file, 2).iter()
            if each.get("name") == "set_states"
        ]
        states = [word for line in called for word in shlex.split(line)]
        wanted = [step for step in steps if step.transitions and step.ros]
        assert states[::2] == [step.ros.full_name for step in wanted if step.ros]
        assert states[1::2] == [",".join(words[-1] for words in step.transitions) for step in wanted]
    top = read_launch_file(next((package / "launch").glob("*.launch.xml")), 2)
    included = [str(each.get("file")).rpartition("/")[2].removesuffix(".launch.xml") for each in top.iter("include")]
    assert included == [host or "no-host" for host in plan.hosts]


def test_words_of_the_model_stay_words_in_ros_2(tmp_path: Path) -> None:
    package, left_out = make_launch_workspace(write_simple(tmp_path / "p", "jazzy"), tmp_path / "ws", "ros2_launch")
    assert left_out == []
    root = read_launch_file(package / "launch" / "hosts" / "pc.launch.xml", 2)
    assert [each.tag for each in root] == ["executable", "node", "node_container"]
    program, node, container = root
    assert shlex.split(read_literal_2(str(program.get("cmd")))) == ["prog", *WORDS]
    assert shlex.split(read_literal_2(str(node.get("args")))) == ["prog", *WORDS]
    assert [(each.get("name"), read_literal_2(str(each.get("value")))) for each in node.iter("env")] == [
        ("HOSTILE", " ".join(WORDS))
    ]
    assert read_literal_2(str(node.get("cwd"))) == "/d $(env X)"
    assert (node.get("respawn"), node.get("respawn_delay"), node.get("namespace")) == ("true", "2.0", "/front")
    assert node.get("launch-prefix") == "sudo -n -E -u robot --"
    assert [(each.get("from"), each.get("to")) for each in node.iter("remap")] == [("raw", "/image"), ("/tf", "tf")]
    sources = [read_text_2(str(each.get("from"))) for each in node.iter("param") if each.get("from")]
    own = ("find-pkg-share", "bot_bringup")
    assert sources == [
        [own, ("text", "/config/cam_defaults.yaml")],
        [("find-pkg-share", "cams"), ("text", "/more.yaml")],
        [("text", "/etc/cam.yaml")],
        [("env", "HOME"), ("text", "/cam.yaml")],
        [own, ("text", "/config/cam.yaml")],
    ]
    filled = {
        each.get("name"): (read_text_2(str(each.get("value"))), each.get("type"))
        for each in node.iter("param")
        if each.get("name")
    }
    assert filled == {
        "map": ([("find-pkg-share", "maps"), ("text", "/"), ("env", "HOUSE"), ("text", ".yaml")], "str"),
        "port": ([("env", "PORT")], None),
    }
    (loaded,) = container.iter("composable_node")
    assert (loaded.get("pkg"), loaded.get("plugin")) == ("bot_g", "bot_g::Det")
    commands = [read_text_2(str(each.get("value"))) for each in loaded.iter("param") if each.get("name")]
    assert [(kind, shlex.split(text)) for ((kind, text),) in commands] == [
        ("command", ["xacro", "it's $(env HOME) \\"])
    ]
    assert read_parameters(package, "cam_defaults") == {
        "/front/cam": {"ros__parameters": {"use_sim_time": True, "rate": 10.0, "text": "yes", "list": ["a", "1"]}}
    }
    assert read_parameters(package, "cam") == {
        "/front/cam": {"ros__parameters": {"rate": 20.0, "a.b": 1, "a.c": True, "text": "$(eval 1) \\ 'x'"}}
    }
    assert read_parameters(package, "box") == {"/**/box": {"ros__parameters": {"thread_num": 2, "beat": 1}}}
    # Who loads a node knows no other pattern.
    assert read_parameters(package, "det") == {"/**": {"ros__parameters": {"use_sim_time": True, "size": 1}}}


def read_parameters(package: Path, name: str) -> object:
    return yaml.safe_load((package / "config" / f"{name}.yaml").read_text(encoding="utf-8"))


def test_words_of_the_model_stay_words_in_ros_1(tmp_path: Path) -> None:
    package, left_out = make_launch_workspace(write_simple(tmp_path / "p", "noetic"), tmp_path / "ws", "ros1_launch")
    assert left_out == []
    root = read_launch_file(package / "launch" / "hosts" / "pc.launch", 1)
    assert [each.tag for each in root] == ["param", "node", "node", "node", "node"]
    time, program, node, manager, loaded = root
    assert (time.get("name"), time.get("value")) == ("/use_sim_time", "true")
    assert (program.get("pkg"), program.get("type")) == ("bot_bringup", "run_program")
    assert read_words_1(str(program.get("args"))) == ["prog", *WORDS]
    assert read_words_1(str(node.get("args"))) == ["prog", *WORDS]
    assert (manager.get("pkg"), manager.get("args"), manager.get("ns")) == ("nodelet", "manager", "/front")
    assert read_words_1(str(loaded.get("args"))) == ["load", "bot_g/Det", "/front/box"]
    assert [read_text_1(str(each.get("value"))) for each in node.iter("env")] == [" ".join(WORDS)]
    assert read_words_1(str(node.get("launch-prefix"))) == [
        *["sudo", "-n", "-E", "-u", "robot", "--", "env", "-C"],
        "/d $(env X)",
    ]
    assert [(each.get("from"), each.get("to")) for each in node.iter("remap")] == [("raw", "/image"), ("/tf", "tf")]
    assert [each.get("file") for each in node.iter("rosparam")] == [
        "$(find bot_bringup)/config/cam_defaults.yaml",
        "$(find cams)/more.yaml",
        "/etc/cam.yaml",
        "$(env HOME)/cam.yaml",
        "$(find bot_bringup)/config/cam.yaml",
    ]
    assert {each.get("name"): each.get("value") for each in node.iter("param")} == {
        "map": "$(find maps)/$(env HOUSE).yaml",
        "port": "$(env PORT)",
    }
    (described,) = loaded.iter("param")
    assert read_words_1(str(described.get("command"))) == ["xacro", "it's $(env HOME) \\"]
    assert read_parameters(package, "cam") == {"rate": 20.0, "a": {"b": 1, "c": True}, "text": "$(eval 1) \\ 'x'"}
    assert read_parameters(package, "cam_defaults") == {"rate": 10.0, "text": "yes", "list": ["a", "1"]}


@pytest.mark.parametrize("attack", hostile.TEXTS)
@pytest.mark.parametrize("ros", [1, 2])
def test_hostile_texts_break_out_of_nothing(attack: str, ros: int, tmp_path: Path) -> None:
    data = hostile.project(hostile.TEXTS[attack])
    if ros == 1:
        data["ros"]["distro"] = "noetic"
        data["types"] = json.loads(json.dumps(data["types"]).replace("/msg/", "/"))
    (tmp_path / "archgen.yaml").write_text(hostile.written(data), encoding="utf-8")
    package, _ = make_launch_workspace(tmp_path, tmp_path / "ws", f"ros{ros}_launch")
    files = [*package.rglob("*.launch"), *package.rglob("*.launch.xml")]
    assert len(files) == 4
    for file in files:
        root = read_launch_file(file, ros)
        assert {each.tag for each in root} <= {"arg", "group", "include", "node", "node_container", "executable"}
    ET.parse(package / "package.xml")  # noqa: S314 - of archgen itself
    for file in package.rglob("*.yaml"):
        assert isinstance(yaml.safe_load(file.read_text(encoding="utf-8")), dict)


@pytest.mark.parametrize(("ros", "distro"), [(1, "jazzy"), (2, "noetic")])
def test_a_project_of_the_other_ros_is_told_so(ros: int, distro: str, tmp_path: Path) -> None:
    project = write_simple(tmp_path / "p", distro)
    package, left_out = make_launch_workspace(project, tmp_path / "ws", f"ros{ros}_launch")
    assert left_out == [f"the project is made for ROS {3 - ros}: there is nothing to launch in ROS {ros}"]
    assert not (package / "launch").exists()


def test_states_are_set_one_after_the_other(tmp_path: Path) -> None:
    package, _ = make_launch_workspace(EXAMPLES["courier"], tmp_path / "ws", "ros2_launch")
    script = package / "scripts" / "set_states"
    # The first answer is that there is no such node yet; the node /b has no transitions at all.
    (tmp_path / "ros2").write_text(
        f'#!/bin/sh\necho "$*" >> {tmp_path}/asked\n[ "$3" != /b ] && [ "$(wc -l < {tmp_path}/asked)" -gt 1 ]\n',
        encoding="utf-8",
    )
    (tmp_path / "ros2").chmod(0o755)
    environment = {"PATH": f"{tmp_path}:/usr/bin:/bin", "SET_STATES_ATTEMPTS": "2"}
    done = subprocess.run(  # noqa: S603 - the script that was just generated
        [script, "/a", "configure,activate", "/b", "configure", "/c", "configure"],
        env=environment,
        capture_output=True,
        text=True,
        check=False,
    )
    assert done.returncode == 1
    assert "/b: no configure after 2 attempts" in done.stderr
    assert (tmp_path / "asked").read_text(encoding="utf-8").splitlines() == [
        "lifecycle set /a configure",
        "lifecycle set /a configure",
        "lifecycle set /a activate",
        "lifecycle set /b configure",
        "lifecycle set /b configure",
    ]


def test_programs_do_not_see_what_roslaunch_adds(tmp_path: Path) -> None:
    package, _ = make_launch_workspace(write_simple(tmp_path / "p", "noetic"), tmp_path / "ws", "ros1_launch")
    script = package / "scripts" / "run_program"
    words = ["printf", "%s\\n", "a b", "", "-n", "__name:=x", "__log:=/tmp/x.log"]
    done = subprocess.run([script, *words], capture_output=True, text=True, check=True)  # noqa: S603 - just generated
    assert done.stdout == "a b\n\n-n\n"


@pytest.mark.parametrize(
    ("ros", "distro", "name"), [(1, "noetic", "run_program"), (2, "", "set_states"), (2, "scheduled", "run_scheduled")]
)
def test_shellcheck_finds_nothing(ros: int, distro: str, name: str, tmp_path: Path) -> None:
    project = write_simple(tmp_path / "p", distro) if distro == "noetic" else EXAMPLES["courier"]
    if distro == "scheduled":
        project = tmp_path / "archgen.yaml"
        project.write_text(SCHEDULED.replace("DISTRO", "jazzy"), encoding="utf-8")
    package, _ = make_launch_workspace(project, tmp_path / "ws", f"ros{ros}_launch")
    check_by_shellcheck(package / "scripts" / name)


SCHEDULED = """\
archgen: 1
project: {id: bot, title: Bot}
ros: {distro: DISTRO}
groups: {g: {components: {a: A, b: B, c: C, d: D}}}
hosts: {prefix: {cores: 4}, pc: {cores: 2}}
containers: {box: {host: prefix}}
nodes:
  a: {implements: a, host: prefix, package: p, executable: a, timing: {rate: 10 Hz, wcet: 1 ms, priority: 20, cores: [0, 2]}}
  b: {implements: b, host: prefix, package: p, executable: b, start: {user: robot}, timing: {rate: 10 Hz, wcet: 1 ms, priority: 20, cores: [0, 2]}}
  c: {implements: c, container: box, package: p, plugin: "p::C", timing: {rate: 10 Hz, wcet: 1 ms, core: 3}}
  d: {implements: d, host: pc, package: p, executable: d}
"""


@pytest.mark.parametrize(("ros", "distro"), [(1, "noetic"), (2, "jazzy")])
def test_processes_start_with_the_priorities_and_cores_of_timing(ros: int, distro: str, tmp_path: Path) -> None:
    project = tmp_path / "p"
    project.mkdir()
    (project / "archgen.yaml").write_text(SCHEDULED.replace("DISTRO", distro), encoding="utf-8")
    package, _ = make_launch_workspace(project, tmp_path / "ws", f"ros{ros}_launch")
    ending, variable = ("launch", "arg") if ros == 1 else ("launch.xml", "var")
    launched = read_launch_file(package / "launch" / "hosts" / f"prefix.{ending}", ros)
    values = [
        (each.get("name"), each.get("value"), each.get("if"), each.get("unless"))
        for each in launched.iter("arg" if ros == 1 else "let")
        if each.get("value") is not None
    ]
    asked = f"$({variable} scheduling)"
    script = (
        "$(find bot_bringup)/scripts/run_scheduled"
        if ros == 1
        else "$(find-pkg-prefix bot_bringup)/lib/bot_bringup/run_scheduled"
    )
    assert values == [
        ("chrt_f_20_taskset_c_0_2", f"{script} chrt -f 20 taskset -c 0,2 --", asked, None),
        ("chrt_f_20_taskset_c_0_2", "", None, asked),
        ("taskset_c_3", f"{script} taskset -c 3 --", asked, None),
        ("taskset_c_3", "", None, asked),
    ]
    # Found in both spaces of catkin, whatever path `sudo` leaves.
    assert "scripts/run_scheduled " in (package / "CMakeLists.txt").read_text(encoding="utf-8")
    both = f"$({variable} chrt_f_20_taskset_c_0_2)"
    prefixes = {each.get("name"): each.get("launch-prefix") for each in launched.iter() if each.get("launch-prefix")}
    assert {name: str(value).strip() for name, value in prefixes.items()} == {
        "a": both,
        # The rights that count are those of the user whose process it is.
        "b": f"sudo -n -E -u robot -- {both}",
        "box": f"$({variable} taskset_c_3)",
    }
    # Above, one argument for all computers; a computer is not called as an argument that is there already.
    system = ET.parse(package / "launch" / f"bot.{ending}").getroot()  # noqa: S314 - just generated
    assert [each.get("name") for each in system.findall("arg")] == ["prefix", "host_prefix", "pc", "scheduling"]
    passed = {str(each.get("file"))[-20:]: [arg.get("name") for arg in each] for each in system.iter("include")}
    assert list(passed.values()) == [["prefix", "scheduling"], ["prefix"]]


@pytest.mark.parametrize("allowed", ["chrt taskset", "taskset", ""])
def test_what_a_computer_does_not_allow_is_left_out_in_words(allowed: str, tmp_path: Path) -> None:
    (tmp_path / "p").mkdir()
    (tmp_path / "p" / "archgen.yaml").write_text(SCHEDULED.replace("DISTRO", "jazzy"), encoding="utf-8")
    package, _ = make_launch_workspace(tmp_path / "p", tmp_path / "ws", "ros2_launch")
    for name in ("chrt", "taskset"):
        body = 'shift 2\nUSED="${USED-}$0 " exec "$@"' if name in allowed else 'echo "$0: not permitted" >&2\nexit 1'
        (tmp_path / name).write_text(f"#!/bin/sh\n{body}\n", encoding="utf-8")
        (tmp_path / name).chmod(0o755)
    done = subprocess.run(  # noqa: S603 - the script that was just generated
        [
            package / "scripts/run_scheduled",
            *["chrt", "-f", "20", "taskset", "-c", "0,2", "--", "sh", "-c"],
            'echo "$USED|$*"',
            "sh",
            "a b",
            "--",
        ],
        env={"PATH": f"{tmp_path}:/usr/bin:/bin", "USED": ""},
        capture_output=True,
        text=True,
        timeout=60,
        check=True,
    )
    used = "".join(f"{tmp_path}/{name} " for name in allowed.split())
    assert done.stdout == f"{used}|a b --\n"
    assert done.stderr.splitlines() == [
        f'sh starts without "{words}", and no bound of archgen holds: {tmp_path}/{words.split()[0]}: not permitted'
        for words in ("chrt -f 20", "taskset -c 0,2")
        if words.split()[0] not in allowed
    ]
