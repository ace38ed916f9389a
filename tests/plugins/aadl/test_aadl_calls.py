"""A chain through services and actions is a flow: calls have ports for their request and their answer beside the call itself."""

from __future__ import annotations

import re
from fractions import Fraction
from pathlib import Path

import yaml

from archgen.pipeline import check_project
from archgen.plugins.aadl.aadl_import import read_aadl
from archgen.timing.chains.chain_bounds import bound_all_chains
from archgen.timing.run_analysis import analyse_architecture
from tests.plugins.aadl.aadl_judge import find_member, judge_packages
from tests.plugins.aadl.aadl_texts import merge_slices
from tests.plugins.aadl.test_aadl import list_whole_flows, read_latency, write_files

PROJECT = """\
archgen: 1
project: {id: asking}
ros: {distro: jazzy}
types:
  Ask: {request: {what: string, places: "float32[3]"}, response: {found: {type: bool, comment: Or not}}}
  Question: {fields: {text: string}}
  Typed: {request: Question, response: Question}
  Fetch: {request: {what: Question}, response: {}, feedback: {done: float32}}
  Reset: {message: std_srvs/srv/Trigger}
  Phase: {values: [IDLE, RUN]}
groups:
  front:
    components:
      button:
        role: source
        timing: {behaviour: periodic, period: 50 ms, wcet: 1 ms}
        outputs: {press: {type: std_msgs/msg/Empty}}
      asker:
        timing: {behaviour: event, wcet: 2 ms}
        inputs:
          press: {from: [front.button.press]}
          ask: {from: [back.server.ask]}
          reset: {from: [back.deep.reset]}
  back:
    components:
      server:
        role: reactive
        timing: {behaviour: on_demand, wcet: 3 ms}
        outputs: {ask: {type: Ask}, typed: {type: Typed}, fetch: {type: Fetch}, phase: {type: Phase}}
      deep:
        components:
          inner:
            timing: {behaviour: on_demand, wcet: 1 ms}
            outputs: {reset: {type: Reset}, done: {type: std_msgs/msg/Bool}}
        outputs: {reset: {type: Reset, from: [inner.reset]}, done: {type: std_msgs/msg/Bool, from: [inner.done]}}
      viewer: {timing: {behaviour: event, wcet: 1 ms}, role: sink, inputs: {done: {from: [back.deep.done]}}}
nodes:
  button: {implements: front.button, host: pc}
  asker: {implements: front.asker, host: pc}
  server: {implements: back.server, host: board}
  inner: {implements: back.deep.inner, host: board}
  viewer: {implements: back.viewer, host: board}
hosts: {pc: {scheduling: fixed_priority, cores: 1}, board: {scheduling: fixed_priority, cores: 1}}
links: {lan: {connects: [pc, board], bandwidth: 100 Mbit/s, latency: {best: 100 us, worst: 2 ms}}}
chains:
  asked: {through: [front.button, front.asker, back.server], deadline: 100 ms}
  answered: {through: [front.button, front.asker, back.server, front.asker], deadline: 200 ms}
  done: {through: [front.button, front.asker, back.deep.inner, back.viewer], deadline: 200 ms}
"""


def test_latencies_through_calls_add_up(tmp_path: Path) -> None:
    (tmp_path / "archgen.yaml").write_text(PROJECT, encoding="utf-8")
    project = check_project(tmp_path)
    assert not project.has_errors, [each.message for each in project.findings]
    files = write_files(project, tmp_path / "ws")
    packages = judge_packages(files)
    results = bound_all_chains(analyse_architecture(project.architecture), project.architecture)
    totals: dict[str, Fraction] = {}
    for home, system, name, tokens in list_whole_flows(packages):
        totals[name] = Fraction(0)
        for step in "".join(tokens[6 : tokens.index("{")]).split("->"):
            if "." in step:
                totals[name] += read_latency(find_member(packages, home, system, step) or [], "Latency")
            elif "Latency" in dict(system.sections["connections"])[step]:
                totals[name] += read_latency(dict(system.sections["connections"])[step], "Latency")
    assert totals == {name: result.bound.value for name, result in results.items() if result.bound.complete}
    assert set(totals) >= {"asked", "done"}
    system_text = files["aadl/asking.aadl"]
    assert "asker_ask_request: out event data port asking_types::Ask_Request {" in system_text
    assert "server_x_ask_answer: out event data port asking_types::Ask_Response {" in system_text
    assert "is no end to end flow" not in system_text
    said_of_calls = re.findall(r": subprogram access \S+ -> \S+ \{([^}]*)\}", system_text)
    assert said_of_calls
    assert "Latency" not in "".join(said_of_calls)  # which is that of one way


def test_calls_come_back_without_their_ports(tmp_path: Path) -> None:
    (tmp_path / "archgen.yaml").write_text(PROJECT, encoding="utf-8")
    write_files(check_project(tmp_path), tmp_path / "ws")
    imported = read_aadl(sorted((tmp_path / "ws" / "aadl").iterdir()))
    sections, project = merge_slices(imported), yaml.safe_load(PROJECT)
    assert imported.notes == ()
    for section in ("types", "groups", "nodes", "chains"):
        assert sections[section] == project[section], section
