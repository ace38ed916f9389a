"""AADL: what is written is AADL, says what the architecture says, and its flows add up to our bounds."""

from __future__ import annotations

import re
from collections.abc import Iterator
from fractions import Fraction
from pathlib import Path

import pytest

from archgen.pipeline import CheckedProject, check_project
from archgen.plugins.aadl.views.aadl_view import make_view
from archgen.products.output_options import OutputOptions
from archgen.products.project_views import select_elements
from archgen.products.workspace_product import write_workspace
from archgen.timing.chains.chain_bounds import bound_all_chains
from archgen.timing.run_analysis import analyse_architecture
from archgen.views.generation.generation_context import GenerationContext
from tests import hostile
from tests.judged_projects import judge_ramcip, judge_shipped
from tests.plugins.aadl.aadl_judge import Classifier, find_member, judge_packages
from tests.property_sizes import try_some
from tests.running import ROOT, contents

EXAMPLES = [
    pytest.param("example_ramcip", marks=pytest.mark.slow),
    *(f"examples/{name}" for name in ("arm", "bringup", "cleaning_robot", "drone", "first_robot", "reference_system")),
    "examples/vehicle/scenario",
    "examples/vehicle/two_lasers",
]
LAB = """\
archgen: 1
project: {id: lab, title: The lab}
ros: {distro: jazzy}
types:
  Chat: {message: chat_msgs/msg/Chat, comment: "What \\"they\\" say: 100 %", size: 12 B}
  chat: {fields: {text: string, end: "float64[3]", other: "Chat[]", name: "string<=8"}}
  Ask: {message: chat_msgs/srv/Ask}
  Go: {message: chat_msgs/action/Go}
groups:
  g:
    components:
      talker:
        role: source
        inputs: {}
        outputs: {chatter: Chat}
        hints:
          aadl:
            internal_state: {schema: talker.schema.json}
            threads: {publisher: {functions: {function: {source_text: [talker.h], source_name: talk}}}}
            access: {tf: {kind: requires data access, type: "ros::tf"}}
            source_text: [talker.json]
      listener: {role: sink, inputs: {chatter: {from: [talker.chatter, access.data]}}, outputs: {}}
      access: {inputs: {end: {from: talker.chatter}}, outputs: {data: chat, end_x: Chat}}
      relay: {timing: {trigger: any, wcet: 1 ms}, role: filter, inputs: {in: {from: talker.chatter}}, outputs: {out: Chat}}
      server: {role: reactive, inputs: {}, outputs: {ask: Ask}}
      walker: {inputs: {ask: {from: server.ask}, chatter: {from: relay.out}}, outputs: {go: Go}}
      caller: {inputs: {go: {from: walker.go}}, outputs: {}}
nodes:
  talker:
    implements: talker
    host: pc
    publishes: {chatter: {topic: /chatter, own_name: /out_chat}}
    timing: {period: 10 ms, wcet: 2 ms, bcet: 1 ms}
  listener: {implements: listener, host: laptop, subscribes: {chatter: {qos: {depth: 7}}}, timing: {trigger: any, wcet: 1 ms}}
  data: {implements: access, container: box}
  both:
    implements: [relay, server]
    host: pc
hosts: {pc: {cores: 4, scheduling: edf}, laptop: {}}
containers: {box: {host: pc, threads: 2}}
links: {lan: {hints: {aadl: {category: bus}}, connects: [pc, laptop], bandwidth: 100 Mbit/s, latency: {best: 100 us, worst: 2 ms}}}
chains: {heard: {through: [talker, listener], deadline: 50 ms}, inside: {through: [talker, relay]}}
"""


@pytest.fixture(scope="module")
def lab(tmp_path_factory: pytest.TempPathFactory) -> CheckedProject:
    folder = tmp_path_factory.mktemp("lab")
    (folder / "archgen.yaml").write_text(LAB, encoding="utf-8")
    checked_project = check_project(folder)
    assert not checked_project.has_errors, [each.message for each in checked_project.findings]
    return checked_project


def write_files(project: CheckedProject, folder: Path, options: OutputOptions | None = None) -> dict[str, str]:
    result = write_workspace(project, options or OutputOptions(), "aadl", folder)
    assert result.findings == ()
    return {path: data.decode() for path, data in contents(folder).items() if path.endswith(".aadl")}


def find_line(text: str, pattern: str) -> str:
    """Return the one line with something, and blanks taken off."""
    (line,) = [each.strip() for each in text.splitlines() if re.search(pattern, each)]
    return line


@pytest.mark.parametrize("example", try_some(EXAMPLES, 4))
def test_every_example_is_aadl(example: str, tmp_path: Path) -> None:
    project = judge_shipped(ROOT / example)
    packages = judge_packages(write_files(project, tmp_path))
    classifiers = [classifier for each in packages.values() for classifier in each.values()]
    parts = [part for each in classifiers for part in each.sections.get("subcomponents", ())]
    programs = [tokens for _, tokens in parts if tokens[2] == "process"]
    devices = [tokens for _, tokens in parts if tokens[2] == "device" and f"{tokens[3]}".endswith("_devices")]
    assert len(programs) + len(devices) == len(project.architecture.nodes)


@pytest.mark.parametrize("text", list(hostile.TEXTS))
def test_hostile_text_stays_text(text: str, tmp_path: Path) -> None:
    (tmp_path / "archgen.yaml").write_text(hostile.written(hostile.project(hostile.TEXTS[text])), "utf-8")
    judge_packages(write_files(check_project(tmp_path), tmp_path / "ws"))


def test_nodes_are_processes_with_the_threads_of_the_library(lab: CheckedProject, tmp_path: Path) -> None:
    files = write_files(lab, tmp_path)
    nodes = files["aadl/lab_nodes.aadl"]
    assert "thread publisher_talker extends ros::publisher (message => data lab_types::Chat)" in nodes
    assert "thread callback_listener extends" not in nodes  # it reads two types
    assert "thread call_pub_both_relay extends ros::call_pub" in nodes
    assert "thread service_provider_both_server extends ros::service_provider (service => subprogram" in nodes
    assert find_line(nodes, r"^\s+Period => ") == "Period => 10 ms applies to publisher;"
    assert "Compute_Execution_Time => 1 ms .. 2 ms applies to publisher;" in nodes
    assert 'topic_properties::Default_Name => "/out_chat";' in nodes
    assert 'topic_properties::Name => "/chatter";' in files["aadl/lab.aadl"]
    assert "Queue_Size => 7 applies to listener.chatter_chatter;" in nodes
    assert 'archgen::Component => "g.relay";' in nodes


def test_keywords_and_names_that_differ_in_case_are_renamed(lab: CheckedProject, tmp_path: Path) -> None:
    files = write_files(lab, tmp_path)
    types, nodes = files["aadl/lab_types.aadl"], files["aadl/lab_nodes.aadl"]
    assert {"data Chat extends chat_msgs::Chat", "data chat_2"} <= {each.strip() for each in types.splitlines()}
    assert 'archgen::Id => "chat";' in types
    assert 'archgen::Description => "What %22they%22 say: 100 %25";' in types
    assert find_line(types, r"^\s+end_x:") == "end_x: data Base_Types::Float_64[3] {"
    assert 'archgen::Field_Type => "Chat[]";' in types
    assert 'archgen::Field_Type => "string<=8";' in types
    assert "process data_x extends ros::node" in nodes
    assert {"end_x: in event data port lab_types::Chat {", "end_x_2: out data port lab_types::Chat {"} <= {
        each.strip() for each in nodes.splitlines()
    }


def test_an_input_of_several_types_is_several_features_of_one_id(lab: CheckedProject, tmp_path: Path) -> None:
    nodes = write_files(lab, tmp_path)["aadl/lab_nodes.aadl"]
    listener = nodes[nodes.index("process listener") : nodes.index("end listener;")]
    assert "chatter_chatter: in event data port lab_types::Chat" in listener
    assert "chatter_data: in event data port lab_types::chat_2" in listener
    assert listener.count('archgen::Id => "chatter"') == 2


def test_services_and_actions_are_subprograms(lab: CheckedProject, tmp_path: Path) -> None:
    files = write_files(lab, tmp_path)
    messages = files["aadl/chat_msgs.aadl"]
    assert "request: in parameter Ask_Request;" in messages
    assert "feedback: out event data port Go_Feedback;" in messages
    assert 'archgen::Flow_Kind => "action";' in messages
    assert "go: provides subprogram access lab_types::Go" in files["aadl/lab_nodes.aadl"]
    assert "subprogram access walker.go -> caller.go" in files["aadl/lab.aadl"]


def test_computers_containers_and_links(lab: CheckedProject, tmp_path: Path) -> None:
    files = write_files(lab, tmp_path)
    hosts, system = files["aadl/lab_hosts.aadl"], " ".join(files["aadl/lab.aadl"].split())
    assert "Scheduling_Protocol => (EARLIEST_DEADLINE_FIRST_PROTOCOL);" in hosts
    assert "Transmission_Time => [Fixed => 0 ns .. 0 ns; PerByte => 80 ns .. 80 ns;];" in hosts
    assert "Latency => 100 us .. 2 ms;" in hosts
    assert "archgen::Cores => 4;" in hosts
    assert "archgen::Threads => 2;" in hosts
    assert "Actual_Processor_Binding => (reference (box)) applies to g.access_x;" in system
    assert "Actual_Processor_Binding => (reference (pc)) applies to box;" in system
    assert "Actual_Connection_Binding => (reference (lan)) applies to g.talker_chatter_to_listener" in system


def test_what_was_imported_from_aadl_goes_back(lab: CheckedProject, tmp_path: Path) -> None:
    files = write_files(lab, tmp_path)
    nodes = files["aadl/lab_nodes.aadl"]
    assert 'Source_Text => ("talker.schema.json") applies to internal_state;' in nodes
    assert 'Source_Text => ("talker.h") applies to publisher.function;' in nodes
    assert 'Source_Name => "talk" applies to publisher.function;' in nodes
    assert 'Source_Text => ("talker.json");' in nodes
    assert "talker_tf: data access tf -> talker.tf;" in files["aadl/lab.aadl"]


def read_latency(tokens: list[str], name: str) -> Fraction:
    """Return the upper end of a range of durations, in ns."""
    units = {
        "sec": Fraction(10**9),
        "ms": Fraction(10**6),
        "us": Fraction(1000),
        "ns": Fraction(1),
        "ps": Fraction(1, 1000),
    }
    start = tokens.index("..", tokens.index(name))
    return Fraction(tokens[start + 1]) * units[tokens[start + 2]]


@pytest.mark.parametrize("example", EXAMPLES)
def test_latencies_add_up_to_our_bounds(example: str, tmp_path: Path) -> None:
    project = judge_shipped(ROOT / example)
    packages = judge_packages(write_files(project, tmp_path))
    results = bound_all_chains(analyse_architecture(project.architecture), project.architecture)
    for home, system, name, tokens in list_whole_flows(packages):
        result = results[name]
        if "Actual_Latency" not in tokens:
            assert not result.bound.complete
            continue
        assert abs(read_latency(tokens, "Actual_Latency") - result.bound.value) < 1  # type: ignore[operator]
        connections = dict(system.sections["connections"])
        steps = "".join(tokens[6 : tokens.index("{")]).split("->")
        total = Fraction(0)
        for step in steps:
            if "." in step:
                total += read_latency(find_member(packages, home, system, step) or [], "Latency")
            elif "Latency" in connections[step]:
                total += read_latency(connections[step], "Latency")
        assert abs(total - result.bound.value) < len(steps)  # type: ignore[operator] # each is rounded to ps


def list_whole_flows(
    packages: dict[str, dict[str, Classifier]],
) -> Iterator[tuple[str, Classifier, str, list[str]]]:
    """Yield the end to end flows with the package and the system that they stand in."""
    for home, classifiers in packages.items():
        for system in classifiers.values():
            for name, tokens in system.sections.get("flows", ()):
                if tokens[2:5] == ["end", "to", "end"]:
                    yield home, system, name, tokens


def test_flows_of_systems_are_those_inside(tmp_path: Path) -> None:
    packages = judge_packages(write_files(judge_shipped(ROOT / "examples/arm"), tmp_path))
    systems = packages["two_arms"]
    (flow,) = [tokens for _, tokens in systems["body.impl"].sections["flows"]]
    inside = "".join(flow[2:])
    assert inside == "flowsinkleft_arm_path_x->left_arm_path_x_link->left_arm.path_x_flow"
    assert read_latency(systems["body"].sections["flows"][0][1], "Latency") == Fraction(57_550_000)
    assert len(list(list_whole_flows(packages))) == 1


def test_chains_that_are_no_flows_are_told(lab: CheckedProject, tmp_path: Path) -> None:
    system = write_files(lab, tmp_path)["aadl/lab.aadl"]
    assert "heard: end to end flow talker.chatter_flow -> talker_chatter_to_listener -> listener." in system
    assert "Latency => 0 ns .. 50 ms;" in system
    assert "inside: end to end flow" in system
    ramcip = make_view(GenerationContext(judge_ramcip().architecture)).data
    (comment,) = [comment for package in ramcip["packages"] for comment in package["comments"]]
    assert comment.startswith("The chain speech_to_reply is no end to end flow here: from `voice_activity`")


def test_a_selection_has_what_is_selected_and_what_it_needs(lab: CheckedProject, tmp_path: Path) -> None:
    selection = select_elements(lab, "g.talker g.listener")[0]
    files = write_files(lab, tmp_path, OutputOptions(selection, "g.talker g.listener"))
    judge_packages(files)
    assert "process listener extends" in files["aadl/lab_nodes.aadl"]
    assert "process both" not in files["aadl/lab_nodes.aadl"]
    assert "chat_msgs::Go" not in files["aadl/lab_types.aadl"]


@pytest.mark.parametrize(
    "broken",
    [
        "package p\npublic\n  data d\n    properties\n  end d;\nend p;\n",
        'package p\npublic\n  data d\n    properties\n      A => "a\\"b";\n  end d;\nend p;\n',
        "package p\npublic\n  data d\n  end e;\nend p;\n",
        "package p\npublic\n  data d extends q::d\n  end d;\nend p;\n",
        "package p\npublic\n  data d\n  end d;\n  data D\n  end D;\nend p;\n",
        "package p\npublic\n  process d\n    features\n      end: in port d;\n  end d;\nend p;\n",
        "package p\npublic\n  system s\n  end s;\n  system implementation s.i\n    connections\n      c: port a.b -> c.d;\n  end s.i;\nend p;\n",
    ],
)
def test_the_judge_refuses(broken: str) -> None:
    with pytest.raises((AssertionError, KeyError, ValueError, IndexError)):
        judge_packages({"aadl/p.aadl": broken})


def test_the_judge_takes_what_is_right() -> None:
    judge_packages({"aadl/p.aadl": "package p\npublic\n  data d\n  end d;\nend p;\n"})
