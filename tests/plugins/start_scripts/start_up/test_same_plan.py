"""Script, units and compose file show the same steps, in the same order and under the same conditions, as `archgen start`."""

from __future__ import annotations

import json
import shlex
import subprocess
from collections import defaultdict
from pathlib import Path
from typing import Any

import jsonschema_rs
import pytest
import yaml

from archgen.bringup.plan_shapes import StartPlan
from archgen.bringup.start_plan import make_start_plan
from archgen.pipeline import check_project
from tests.plugins.start_scripts.start_up.started_workspaces import (
    check_by_shellcheck,
    check_by_systemd,
    make_workspace,
)
from tests.property_sizes import try_some
from tests.running import RAMCIP, ROOT

PROJECTS = {
    "vehicle": ROOT / "examples" / "vehicle" / "scenario",
    "courier": ROOT / "examples" / "bringup",
    "ramcip": RAMCIP,
}
PRINT_STEPS = """\
this_computer() { :; }
other_computer() { :; }
step() { printf '%s\\0' "$#" "$@"; }
start_all() { :; }
"""


class Generated:
    """A project's plan, and the workspace that was generated of it."""

    def __init__(self, project: Path, folder: Path) -> None:
        """Generate it."""
        self.plan: StartPlan = make_start_plan(check_project(project).architecture)
        self.workspace = make_workspace(project, folder)
        self.names = {step.id: step.file_name for step in self.plan.steps}
        self.steps = {step.file_name: step for step in self.plan.steps}
        self.hosts = [path.stem for path in sorted((self.workspace / "start" / "hosts").iterdir())]

    @property
    def waits(self) -> dict[str, set[tuple[str, str]]]:
        """What each step waits for that is started at all."""
        return {
            step.file_name: {(self.names[each.awaited], each.until) for each in step.awaited}
            for step in self.plan.steps
            if step.command
        }

    def read_script(self, host: str) -> list[list[str]]:
        """Return the words of each `step` of a computer's script, as bash reads them."""
        source = (self.workspace / "start" / "hosts" / f"{host}.sh").read_text(encoding="utf-8")
        lines = [line for line in source.splitlines() if not line.startswith("source ")]
        printed = subprocess.run(  # noqa: S603 - of the script only the steps
            ["bash", "-c", PRINT_STEPS + "\n".join(lines)],  # noqa: S607
            capture_output=True,
            check=True,
        ).stdout.decode()
        words = printed.split("\0")[:-1]
        steps = []
        while words:
            count = int(words.pop(0))
            steps.append(words[:count])
            del words[:count]
        return steps

    def read_units(self, host: str) -> dict[str, dict[str, list[str]]]:
        """Return the keys of each unit of a computer, by the unit's name without that of the project."""
        units = {}
        for path in (self.workspace / "start" / "systemd" / host).iterdir():
            keys = defaultdict(list)
            for line in path.read_text(encoding="utf-8").splitlines():
                key, equals, value = line.partition("=")
                if equals and not line.startswith("#"):
                    keys[key].append(value)
            units[path.name.partition("-")[2]] = dict(keys)
        return units

    def read_compose(self, host: str) -> dict[str, Any]:
        """Return the services of a computer."""
        text = (self.workspace / "start" / "compose" / f"{host}.yaml").read_text(encoding="utf-8")
        services: dict[str, Any] = yaml.safe_load(text)["services"]
        return services


@pytest.fixture(scope="module", params=PROJECTS)
def generated(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> Generated:
    return Generated(PROJECTS[request.param], tmp_path_factory.mktemp(request.param) / "ws")


def split_options(words: list[str]) -> tuple[dict[str, list[str]], list[str]]:
    """Return the values of each option that has one word, and the words behind `--`."""
    end = words.index("--") if "--" in words else len(words)
    options = defaultdict(list)
    for place, word in enumerate(words[:end]):
        if word.startswith("--"):
            options[word].append(words[place + 1] if place + 1 < end else "")
    return options, words[end + 1 :]


def test_the_script_has_the_plan(generated: Generated) -> None:
    found_waits: dict[str, set[tuple[str, str]]] = {}
    for host in generated.hosts:
        numbers = []
        for name, *words in generated.read_script(host):
            options, command = split_options(words)
            step = generated.steps[name]
            numbers.append(generated.plan.steps.index(step))
            assert options["--phase"] == [step.phase]
            signs = [(each.kind, each.target) for each in step.signals if each.kind != "end"]
            assert [(kind, options[f"--{kind}"]) for kind, _ in signs] == [(kind, [target]) for kind, target in signs]
            if "--on" in options:
                continue
            assert command == list(step.command)
            assert ("--once" in words) == (step.once and bool(step.command))
            assert options["--within"] in ([step.seconds_at_most] if step.seconds_at_most else [], ["60"])
            if step.command:
                ends = {(each, "ended" if generated.steps[each].once else "ready") for each in options["--after"]}
                found_waits[name] = ends | {(each, "started") for each in options["--after-start-of"]}
        assert numbers == sorted(numbers)
    assert found_waits == generated.waits


def test_the_units_have_the_plan(generated: Generated) -> None:
    for host in generated.hosts:
        units = generated.read_units(host)
        own = [step for step in generated.plan.steps if (step.host or "no-host") == host and step.command]
        for step in own:
            unit = units[f"{step.file_name}.service"]
            needed = [each.partition("-")[2] for each in unit.get("Requires", ())]
            assert unit.get("After", []) == unit.get("Requires", [])
            assert {(read_awaited(each, generated), each) for each in needed if each.endswith(".service")} <= {
                (name, f"{name}{'-up' if until == 'ready' and f'{name}-up.service' in units else ''}.service")
                for name, until in generated.waits[step.file_name]
            }
            awaited = {read_awaited(each, generated) for each in needed if each.endswith(".service")}
            seen = {
                name
                for name, _ in generated.waits[step.file_name]
                if {f"{name}.service", f"{name}-up.service"} & set(units)
            }
            assert awaited == seen
            earlier = [phase for phase, _ in generated.plan.phases][
                : [p for p, _ in generated.plan.phases].index(step.phase)
            ]
            assert [each for each in needed if each.endswith(".target")] == [
                f"{phase}.target" for phase in earlier[-1:]
            ]
            words = [word.replace("%%", "%").replace("$$", "$") for word in shlex.split(unit["ExecStart"][0])]
            assert words[-len(step.command) :] == list(step.command)
            watching = units.get(f"{step.file_name}-up.service")
            assert (watching is not None) == bool(step.transitions or [s for s in step.signals if s.kind != "end"])
            if watching and step.seconds_at_most:
                assert watching["TimeoutStartSec"] == [step.seconds_at_most]


def read_awaited(unit: str, generated: Generated) -> str:
    name = unit.rpartition(".")[0]
    return name if name in generated.steps else name.removesuffix("-up")


def test_the_compose_file_has_the_plan(generated: Generated) -> None:
    for host in generated.hosts:
        services = generated.read_compose(host)
        for step in generated.plan.steps:
            if (step.host or "no-host") != host or not step.command:
                continue
            service = services[step.file_name]
            depends_on = {
                read_awaited(f"{name}.", generated): each["condition"]
                for name, each in service.get("depends_on", {}).items()
            }
            phases = [phase for phase, _ in generated.plan.phases]
            before = phases[phases.index(step.phase) - 1] if step.phase != phases[0] else None
            of_phase = {each.file_name for each in generated.plan.steps if each.phase == before}
            waits = generated.waits[step.file_name]
            named = set(services) | {name.removesuffix("-up") for name in services}
            assert set(depends_on) == {name for name, _ in waits if name in named} | (of_phase & named)
            for name, until in waits:
                if name in services and until == "ready" and generated.steps[name].signals:
                    assert depends_on[name] in {"service_healthy", "service_completed_successfully"}
            words = [word.replace("$$", "$") for word in service["command"]]
            assert words[-len(step.command) :] == list(step.command)


def test_all_give_processes_the_same_priorities_and_cores(generated: Generated) -> None:
    for host in generated.hosts:
        scripts = {name: words for name, *words in generated.read_script(host) if "--on" not in words}
        units, services = generated.read_units(host), generated.read_compose(host)
        for step in generated.plan.steps:
            if (step.host or "no-host") != host or not step.command:
                continue
            told = step.scheduling
            front = ["--cpu", str(len(told.words)), *told.words] if told.words else []
            for words in (scripts[step.file_name], services[step.file_name]["command"]):
                at = words.index("--cpu") if "--cpu" in words else None
                assert (words[at : at + len(front)] if at is not None else []) == front
            unit, service = units[f"{step.file_name}.service"], services[step.file_name]
            assert unit.get("CPUAffinity", []) == ([" ".join(map(str, told.cores))] if told.cores else [])
            assert unit.get("CPUSchedulingPriority", []) == ([str(told.priority)] if told.priority else [])
            assert unit.get("CPUSchedulingPolicy", []) == (["fifo"] if told.priority else [])
            assert service.get("ulimits") == ({"rtprio": told.priority} if told.priority else None)
            assert service.get("cap_add") == (["SYS_NICE"] if told.priority else None)
    has_any = any(step.scheduling.words for step in generated.plan.steps)
    assert has_any or "ramcip" not in generated.workspace.parent.name


def test_compose_files_are_what_the_specification_says(generated: Generated) -> None:
    schema = json.loads((ROOT / "tests" / "judges" / "compose-spec.json").read_text(encoding="utf-8"))
    validator = jsonschema_rs.validator_for(schema)
    for host in generated.hosts:
        text = (generated.workspace / "start" / "compose" / f"{host}.yaml").read_text(encoding="utf-8")
        assert [str(error) for error in validator.iter_errors(yaml.safe_load(text))] == []


@pytest.mark.parametrize("generated", try_some(["vehicle", "courier", "ramcip"]), indirect=True)
def test_shellcheck_finds_nothing(generated: Generated) -> None:
    # With what they read; one computer's script is like the other.
    host_scripts = [generated.workspace / "start" / "hosts" / f"{generated.hosts[0]}.sh"]
    scripts = [*host_scripts, *generated.workspace.glob("*.sh"), *(generated.workspace / "start" / "lib").glob("*.sh")]
    check_by_shellcheck(*scripts)


def test_systemd_finds_nothing(generated: Generated) -> None:
    for host in generated.hosts:
        units = sorted((generated.workspace / "start" / "systemd" / host).iterdir())
        check_by_systemd(*units)
