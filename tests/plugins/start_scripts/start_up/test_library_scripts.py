"""What the scripts have in common, each alone: looking whether something is up, and becoming a program."""

from __future__ import annotations

import os
import subprocess
import time
from pathlib import Path

import pytest

from tests.plugins.start_scripts.start_up.started_workspaces import hold_ports
from tests.running import ROOT, archgen_here

LIBRARY = ROOT / "archgen/plugins/start_scripts/backends/start/assets/start/lib"


class Tools:
    """Runs a script with small programs in the place of ROS's."""

    def __init__(self, folder: Path) -> None:
        """Start without any."""
        self.folder = folder
        (folder / "bin").mkdir()

    def add(self, name: str, *lines: str) -> None:
        """Add a program: lines for a shell."""
        file = self.folder / "bin" / name
        file.write_text("\n".join(["#!/bin/sh", f"cd {self.folder}", *lines, ""]), encoding="utf-8")
        file.chmod(0o755)

    def run(self, script: str, *words: str, status: int = 0, **environment: str) -> str:
        """Run a script, which must end with a status, and return its output."""
        done = subprocess.run(  # noqa: S603 - our own script
            ["/usr/bin/env", "bash", str(LIBRARY / script), *words],
            cwd=self.folder,
            env={**os.environ, "PATH": f"{self.folder / 'bin'}:{os.environ['PATH']}", **environment},
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            check=False,
            timeout=120,
        )
        assert done.returncode == status, done.stdout + done.stderr
        return done.stdout

    def look(self, *words: str, status: int = 0, **environment: str) -> str:
        """Look once, and return what is missing."""
        missing = self.folder / "missing"
        self.run("wait_until_up.sh", "--look", "--missing", str(missing), *words, status=status, **environment)
        return missing.read_text(encoding="utf-8").strip()


@pytest.fixture
def tools(tmp_path: Path) -> Tools:
    return Tools(tmp_path)


def test_ports_and_files(tools: Tools) -> None:
    with hold_ports(1) as (port,):
        assert tools.look("--port", str(port), status=1) == f"the port {port} does not accept connections"
    assert tools.look("--file", "x $(y)", status=1) == "there is no file x $(y)"
    (tools.folder / "x $(y)").touch()
    assert tools.look("--file", "x $(y)") == "there is no file x $(y)"


def test_words_of_the_output_that_are_no_older(tools: Tools) -> None:
    output = tools.folder / "output"
    output.write_text("old [ready]\n", encoding="utf-8")
    words = ("--output", str(output), str(output.stat().st_size), "--log", "[ready]")
    assert tools.look(*words, status=1) == 'its output does not hold "[ready]"'
    output.write_text("old [ready]\nnow [ready]\n", encoding="utf-8")
    tools.look(*words)
    tools.look("--output", str(output), "0", "--log", "[ready]\nnow")
    tools.look("--output", str(tools.folder / "none"), "0", "--log", "x", status=1)


def test_messages_and_services_of_both_generations(tools: Tools) -> None:
    tools.add("ros2", 'case "$*" in "topic echo --once /map"|*list) ;; *) exit 1 ;; esac', "cat $2")
    tools.add("rostopic", '[ "$*" = "echo -n 1 /map" ] && exit; [ "$1" = list ] && cat action')
    tools.add("rosservice", "cat list")
    (tools.folder / "list").write_text("/other\n/plan/x\n", encoding="utf-8")
    (tools.folder / "action").write_text("/dock/goal\n", encoding="utf-8")
    assert tools.look("--topic", "/maps", status=1) == "no message has come on /maps"
    assert tools.look("--service", "/plan", status=1) == "/plan is not offered"
    tools.look("--service", "/plan/x", "--topic", "/map", ROS_VERSION="1")
    tools.look("--service", "/dock", ROS_VERSION="1")
    tools.look("--service", "/plan", status=1, ROS_VERSION="1")
    tools.look("--service", "/plan/x")


def test_time_passes(tools: Tools) -> None:
    began = time.monotonic()
    tools.run("wait_until_up.sh", "--time", "0.4")
    assert time.monotonic() - began >= 0.4
    assert tools.look("--time", "100000000000", status=1) == "100000000000 s have not passed"


LIFECYCLE = ("--lifecycle", "/arm", "active", "configure activate")


def test_a_node_is_brought_into_its_state(tools: Tools) -> None:
    tools.add(
        "ros2",
        'case "$*" in',
        '"service list") echo /arm/change_state ;;',
        '"lifecycle set /arm configure") echo inactive > state ;;',
        '"lifecycle set /arm activate") echo "${AFTER:-active}" > state ;;',
        '"lifecycle get /arm") echo "$(cat state) [3]" ;;',
        "esac",
    )
    tools.run("wait_until_up.sh", *LIFECYCLE)
    missing = tools.folder / "missing"
    tools.run("wait_until_up.sh", "--missing", str(missing), *LIFECYCLE, status=2, AFTER="inactive")
    assert missing.read_text(encoding="utf-8") == "/arm is not active\n"


def test_what_cannot_be_loaded_never_comes_up(tools: Tools) -> None:
    tools.add(
        "ros2",
        '[ "$1" = service ] && echo /box/_container/load_node && exit',
        'echo "$@" > loaded',
        "exit ${STATUS:-0}",
    )
    words = ("--load", "/box", "--", "ros2", "component", "load", "/box", "a; b")
    tools.run("wait_until_up.sh", *words)
    assert (tools.folder / "loaded").read_text(encoding="utf-8") == "component load /box a; b\n"
    missing = tools.folder / "missing"
    tools.run("wait_until_up.sh", "--missing", str(missing), *words, status=2, STATUS="3")
    assert missing.read_text(encoding="utf-8") == "loading it into /box failed with status 3\n"


def test_a_program_is_prepared(tools: Tools) -> None:
    (tools.folder / "settings").write_text("A=from_settings $NONE\nexport A\n", encoding="utf-8")
    script = 'echo "$A|$B|$PWD|$*"'
    words = ("--settings", "settings", "--set", "B=$(x) 'y'", "--in", "in", "--before", "2", "touch", "made here")
    (tools.folder / "in").mkdir()
    said = tools.run("run.sh", *words, "--", "sh", "-c", script, "-", "a b", "", START_FOLDER=str(tools.folder))
    assert said == f"from_settings|$(x) 'y'|{tools.folder / 'in'}|a b \n"
    assert (tools.folder / "in" / "made here").exists()
    tools.run("run.sh", "--before", "1", "false", "--", "touch", "never", status=1, START_FOLDER=str(tools.folder))
    assert not (tools.folder / "never").exists()


def test_a_program_has_its_priority_and_cores(tools: Tools) -> None:
    tools.add("chrt", 'printf "%s|" chrt "$@"')
    run = ["--cpu", "3", "chrt", "-f", "20", "--", "echo", "a b"]
    assert tools.run("run.sh", *run) == "chrt|-f|20|echo|a b|"
    assert tools.run("run.sh", *run, START_SCHEDULING="no") == "a b\n"


def test_output_is_copied(tools: Tools) -> None:
    said = tools.run("run.sh", "--by-line", "--copy", "copy", "--", "printf", "a\nb", START_FOLDER=str(tools.folder))
    assert said == "a\nb"
    assert (tools.folder / "copy").read_text(encoding="utf-8") == "a\nb"


def test_parameters_are_the_output_of_commands(tools: Tools) -> None:
    tools.add("rosparam", 'printf "%s\\n" "$@" > param')
    value = ("printf", '<robot name="a">\n\\t\t</robot>')
    said = tools.run(
        "run.sh", "--value", "robot_description", "2", *value, "--", "echo", "--ros-args", START_FOLDER="/"
    )
    assert said == '--ros-args -p robot_description:="<robot name=\\"a\\">\\n\\t\\t</robot>"\n'
    tools.run("run.sh", "--value", "/arm/robot_description", "2", "printf", "a\nb", "--", "true", START_FOLDER="/")
    assert (tools.folder / "param").read_text(encoding="utf-8") == 'set\n/arm/robot_description\n"a\\nb"\n'
    tools.run("run.sh", "--value", "x", "1", "false", "--", "touch", "never", status=1, START_FOLDER=str(tools.folder))


def test_values_are_filled_in_as_launch_files_do(tools: Tools) -> None:
    """Only those of parameters, and only what launch files fill in."""
    tools.add("ros2", '[ "$*" = "pkg prefix --share my_desc" ] && echo \'/opt/my "desc\'')
    tools.add("rospack", '[ "$*" = "find my_desc" ] && echo /opt/desc')
    tools.add("rosparam", 'printf "%s\\n" "$@" > param')
    text = ["-p", 'urdf:="$(find-pkg-share my_desc)/$(env HOUSE)/$(touch trace)"']
    said = tools.run("run.sh", "--fill", "--", "echo", "$(env HOUSE)", *text, START_FOLDER="/", HOUSE="a\\b")
    assert said == '$(env HOUSE) -p urdf:="/opt/my \\"desc/a\\\\b/$(touch trace)"\n'
    for written, filled in (("8080", "8080"), ("-1.5", "-1.5"), ("true", "true"), ("a b", '"a b"'), ("", '""')):
        # What is a text has quotes, and keeps them.
        words = ("-p", "n:x:=$(env PORT)", "-p", 'n:y:="$(env PORT)"')
        said = tools.run("run.sh", "--fill", "--", "echo", *words, START_FOLDER="/", PORT=written)
        assert said == f'-p n:x:={filled} -p n:y:="{written}"\n'
    said = tools.run("run.sh", "--", "echo", *text, START_FOLDER="/")
    assert said == " ".join(text) + "\n"
    setting = ("rosparam", "set", "/arm/$(env HOUSE)", '"$(find my_desc)/x"')
    tools.run("run.sh", "--fill", "--before", "4", *setting, "--", "true", START_FOLDER="/")
    assert (tools.folder / "param").read_text(encoding="utf-8") == 'set\n/arm/$(env HOUSE)\n"/opt/desc/x"\n'
    tools.run("run.sh", "--fill", "--", "echo", "-p", "x:=$(find-pkg-share other)", status=1, START_FOLDER="/")


def test_all_who_start_a_node_fill_in_the_same_values(tmp_path: Path) -> None:
    (tmp_path / "archgen.yaml").write_text(
        "archgen: 1\nproject: {id: p}\nros: {distro: jazzy}\n"
        "groups: {g: {components: {a: {functionality: Acts., parameters: {urdf: '$(find-pkg-share d)/x.urdf'}}, b: {functionality: Acts., parameters: {x: '$(rm d)'}}}}}\n",
        encoding="utf-8",
    )
    for backend in ("start", "ros2_launch"):
        archgen_here("generate", backend, "-o", tmp_path / "w", cwd=tmp_path)
    start = tmp_path / "w" / "start"
    scripts = [
        *start.glob("hosts/*.sh"),
        *start.rglob("p-a.service"),
        *start.rglob("p-b.service"),
        *start.glob("compose/*.yaml"),
    ]
    assert len(scripts) == 4
    found = {each.name: each.read_text(encoding="utf-8").count("--fill") for each in scripts}
    assert found == {"no-host.sh": 1, "p-a.service": 1, "p-b.service": 0, "no-host.yaml": 1}
    (host,) = (tmp_path / "w").rglob("no-host.launch.xml")
    assert 'value="$(find-pkg-share d)/x.urdf"' in host.read_text(encoding="utf-8")


@pytest.mark.parametrize(
    ("status", "declared", "is_text"),
    [
        ("planned", "'$(env PORT)'", True),
        ("existing", "'$(env PORT)'", False),
        ("existing", "{type: string, value: '$(env PORT)'}", True),
        ("planned", "{type: integer, value: '$(env PORT)'}", False),
    ],
)
@pytest.mark.parametrize("distro", ["jazzy", "noetic"])
def test_a_variable_is_a_text_where_the_parameter_is_one(
    distro: str, status: str, declared: str, *, is_text: bool, tmp_path: Path
) -> None:
    """A node of which it is known that it wants a text would not start with a number."""
    (tmp_path / "archgen.yaml").write_text(
        f"archgen: 1\nproject: {{id: p}}\nros: {{distro: {distro}}}\n"
        f"groups: {{g: {{components: {{a: {{functionality: Acts., parameters: {{port: {declared}}}}}}}}}}}\n"
        f"nodes: {{a: {{implements: a, status: {status}, package: own, executable: a}}}}\n",
        encoding="utf-8",
    )
    ros = 1 if distro == "noetic" else 2
    for backend in ("start", f"ros{ros}_launch"):
        archgen_here("generate", backend, "-o", tmp_path / "w", cwd=tmp_path)
    (script,) = (tmp_path / "w").rglob("start/hosts/*.sh")
    (launch,) = (tmp_path / "w").rglob("launch/hosts/no-host.launch*")
    assert ('"$(env PORT)"' in script.read_text(encoding="utf-8")) == is_text
    assert ('type="str"' in launch.read_text(encoding="utf-8")) == is_text


@pytest.mark.parametrize(
    ("words", "expected"),
    [
        (
            "ros2 run p e x:=/y --ros-args -r __node:=a -r in:=/cam/image -r tf:=/tf -r own:=near -p path:=/etc",
            "ros2 run p e x:=/y --ros-args -r __node:=a -r in:=/r2/cam/image -r tf:=/tf -r own:=near -p path:=/etc -r __ns:=/r2",
        ),
        (
            "ros2 run p e --ros-args -r __ns:=/arm -r in:=/cam",
            "ros2 run p e --ros-args -r __ns:=/r2/arm -r in:=/r2/cam",
        ),
        (
            "ros2 component load /box p p::A --node-name a -r in:=/cam",
            "ros2 component load /r2/box p p::A --node-name a -r in:=/r2/cam --node-namespace /r2",
        ),
        (
            "ros2 component load /box p p::A --node-name a --node-namespace /arm -p path:=/etc",
            "ros2 component load /r2/box p p::A --node-name a --node-namespace /r2/arm -p path:=/etc",
        ),
        ("rosrun p e __name:=a in:=/cam _path:=/etc", "rosrun p e __name:=a in:=/r2/cam _path:=/etc __ns:=/r2"),
        (
            "rosrun nodelet nodelet load p/A /box __name:=a __ns:=/arm",
            "rosrun nodelet nodelet load p/A /r2/box __name:=a __ns:=/r2/arm",
        ),
        ("stage /world x:=/y", "stage /world x:=/y"),
    ],
)
def test_a_second_robot_has_names_of_its_own(words: str, expected: str, tools: Tools) -> None:
    for name in ("ros2", "rosrun", "stage"):
        tools.add(name, f'echo {name} "$@"')
    said = tools.run("run.sh", "--same", "/tf", "--", *words.split(), START_FOLDER="/", START_PREFIX="/r2")
    assert said == f"{expected}\n"
    assert tools.run("run.sh", "--", *words.split(), START_FOLDER="/") == f"{words}\n"


def test_what_is_waited_for_has_names_of_its_own_on_a_second_robot(tools: Tools) -> None:
    tools.add(
        "ros2",
        'echo "$*" >> said; [ "$1 $2" != "service list" ] || printf "/r2/plan\\n/r2/a/change_state\\n"; echo "active [3]"',
    )
    tools.look("--service", "/plan", "--lifecycle", "/a", "active", "activate", START_PREFIX="/r2")
    assert tools.look("--service", "/plan", status=1) == "/plan is not offered"
    assert "lifecycle get /r2/a" in (tools.folder / "said").read_text(encoding="utf-8")


def test_parameters_of_a_second_robot_have_their_names(tools: Tools) -> None:
    tools.add("rosparam", 'echo "$@" >> param')
    setting = ("--before", "4", "rosparam", "set", "/arm/x", "1", "--before", "4", "rosparam", "load", "a.yaml", "/arm")
    time = ("--before", "4", "rosparam", "set", "/use_sim_time", "true", "--value", "/arm/y", "2", "echo", "2")
    tools.run("run.sh", *setting, *time, "--", "true", START_FOLDER="/", START_PREFIX="/r2")
    told = (tools.folder / "param").read_text(encoding="utf-8")
    assert told == 'set /r2/arm/x 1\nload a.yaml /r2/arm\nset /use_sim_time true\nset /r2/arm/y "2"\n'


def test_what_respawns_has_no_end_of_it_in_systemd(tmp_path: Path) -> None:
    """By itself systemd gives up after five starts in ten seconds, where a launch file goes on."""
    (tmp_path / "archgen.yaml").write_text(
        "nodes: {a: {kind: program, command: a, start: {respawn: true}}, b: {kind: program, command: b}}\n"
    )
    archgen_here("generate", "start", "-o", tmp_path / "ws", cwd=tmp_path)
    units = {each.name: each.read_text() for each in (tmp_path / "ws").rglob("*.service")}
    assert [name[-9:] for name, text in units.items() if "StartLimitIntervalSec=0" in text] == ["a.service"]
