"""What endpoints are called on the wire, in whole projects: the traps of launches, each by its name."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from archgen.bringup.program_names import ProgramNames
from archgen.derivation.derived_parts import DerivedParts
from archgen.derivation.low_level import derive_low_level
from archgen.model.architecture import Architecture
from archgen.model.node import Endpoint

Derived = Callable[[str], Architecture]


def index_ends(architecture: Architecture) -> dict[str, Endpoint]:
    """Return the endpoints by node."""
    return {each.node: each for each in architecture.endpoints}


PAIR = """
groups: {g: {components: {a: {outputs: {o: std_msgs/msg/Bool}}, b: {inputs: {i: a.o}}}}}
nodes:
  sup: {implements: a, WRITER}
  reader: {implements: b, READER}
"""


def derive_pair(derived: Derived, writer: str, reader: str = "title: R") -> dict[str, Endpoint]:
    """Return the ends of a writer and its reader."""
    return index_ends(derived(PAIR.replace("WRITER", writer).replace("READER", reader)))


def test_a_remap_moves_an_end_and_says_why(derived: Derived) -> None:
    end = derive_pair(derived, "publishes: {o: /safety}, remaps: {/safety: /safety_raw}")["sup"]
    assert (end.program_name, end.name, end.evidence["name"].rule) == ("/safety", "/safety_raw", "/safety:=/safety_raw")
    assert (end.evidence["name"].at.line, end.evidence["name"].at.column) == (4, 58)


def test_without_rules_program_and_wire_have_one_name_and_no_reason(derived: Derived) -> None:
    end = derive_pair(derived, "publishes: {o: /safety}")["sup"]
    assert (end.program_name, end.name, end.evidence) == ("/safety", "/safety", {})


SHARED_PROGRAM = """
component_types: {stop: {outputs: {safety: std_msgs/msg/Bool}}}
groups: {g: {components: {a: {is: stop}, b: {is: stop}, c: {is: stop}}}}
nodes:
  one: {implements: a, package: p, executable: stop, publishes: {safety: /safety}, remaps: {/safety: /raw1}}
  two: {implements: b, package: p, executable: stop, publishes: {safety: /safety2}, remaps: {/safety2: /raw2}}
  three: {implements: c, publishes: {safety: /safety3}, remaps: {/safety3: /raw3}}
"""


def test_trap_1_the_generator_folds_all_rules_into_one_for_each_end(derived: Derived) -> None:
    """Else `safety` became `/safety2` at one of two nodes of a program, which no rule of the model moves on."""
    architecture = derived(SHARED_PROGRAM)
    names = ProgramNames(architecture, 2)
    folded = {each.id: names.find_remaps(each) for each in architecture.nodes.values()}
    assert folded == {"one": {"safety": "/raw1"}, "two": {"safety": "/raw2"}, "three": {"safety": "/raw3"}}
    assert {end.node: end.name for end in architecture.endpoints} == {"one": "/raw1", "two": "/raw2", "three": "/raw3"}


SWAP = """
groups: {g: {components: {a: {outputs: {o: std_msgs/msg/Bool, p: std_msgs/msg/Bool}}}}}
nodes: {sup: {implements: a, publishes: {o: /x, p: /y}, remaps: {/x: /y, /y: /x, /tf: tf}}}
"""
MOVED_BY_ARGUMENTS = """
component_types: {stop: {inputs: {in: std_msgs/msg/Bool}, outputs: {safety: std_msgs/msg/Bool}}}
groups: {g: {components: {a: {is: stop, inputs: {in: b.safety}}, b: {is: stop, inputs: {in: a.safety}}}}}
nodes:
  one: {implements: a, arguments: [--ros-args, -r, "/g/a/safety:=/q", -r, "__ns:=/deep"], remaps: {/tf: tf}}
  two: {implements: b, namespace: /b, publishes: {safety: out}, arguments: ["out:=~/private", --ros-args, -r, "__node:=new"]}
"""


def test_trap_1_a_swap_is_not_swapped_back_in_generated_code(derived: Derived) -> None:
    architecture = derived(SWAP)
    assert [each.name for each in architecture.endpoints] == ["/y", "/x"]
    remaps = ProgramNames(architecture, 2).find_remaps(architecture.nodes["sup"])
    assert remaps == {"o": "/y", "p": "/x", "/tf": "tf"}


def test_trap_2_a_generated_reader_takes_the_wire_name_of_its_writer(derived: Derived) -> None:
    ends = derive_pair(derived, "publishes: {o: /safety}, remaps: {/safety: /safety_raw}")
    assert (ends["reader"].name, ends["reader"].sources) == ("/safety_raw", ("g.a.o",))
    moved = derive_pair(derived, "publishes: {o: /safety}", "remaps: {/safety: /elsewhere}")["reader"]
    assert (moved.program_name, moved.name, moved.sources) == ("/safety", "/elsewhere", ())


def test_trap_2_a_reader_that_exists_does_not_follow(derived: Derived) -> None:
    writer = "publishes: {o: /safety}, remaps: {/safety: /safety_raw}"
    reader = derive_pair(derived, writer, "status: existing")["reader"]
    assert (reader.name, reader.evidence["name"].kind, reader.sources) == (None, "unknown", ("g.a.o",))
    # Where no launch moves its source, the model's connection says what it reads.
    assert derive_pair(derived, "publishes: {o: /safety}", "status: existing")["reader"].name == "/safety"


def test_trap_3_observed_names_are_not_remapped_again(derived: Derived) -> None:
    end = derive_pair(derived, "status: existing, observed: true, publishes: {o: /b}, remaps: {/a: /b, /b: /a}")["sup"]
    assert (end.name, end.evidence["name"].kind) == ("/b", "observed")


def test_trap_6_words_give_the_node_another_name_and_place(derived: Derived) -> None:
    words = '["--ros-args", "-r", "__node:=guard", "-r", "__ns:=/b"]'
    architecture = derived(
        PAIR.replace("WRITER", f"arguments: {words}, publishes: {{o: ~/safety}}").replace("READER", "title: R")
    )
    assert architecture.nodes["sup"].full_name == "/b/guard"
    assert index_ends(architecture)["reader"].name == "/b/guard/safety"


def test_trap_7_an_action_is_moved_by_the_distribution(derived: Derived) -> None:
    text = """
ros: {distro: DISTRO}
groups: {g: {components: {a: {outputs: {o: example_interfaces/action/Fibonacci}}}}}
nodes: {sup: {implements: a, serves: {o: /act}, remaps: {/act: /go}}}
"""
    names = {distro: derived(text.replace("DISTRO", distro)).endpoints[0].name for distro in ("jazzy", "kilted")}
    assert names == {"jazzy": "/act", "kilted": "/go"}


def test_a_program_that_exists_has_no_invented_name(derived: Derived) -> None:
    ends = derive_pair(derived, "status: existing")
    assert [(each.name, each.program_name, each.label) for each in ends.values()] == [
        (None, None, "g.a.o (name not known)"),
        (None, None, "g.a.o (name not known)"),
    ]
    assert derive_pair(derived, "status: existing, publishes: {o: {own_name: out}}")["sup"].name == "/out"
    assert derive_pair(derived, "status: adapted")["sup"].name == "/g/a/o"


def test_unknown_names_keep_the_connections_of_the_model(derived: Derived) -> None:
    architecture = derived(PAIR.replace("WRITER", "status: existing").replace("READER", "status: existing"))
    (topic,) = architecture.topics.values()
    assert (topic.name, [each.node for each in (*topic.writers, *topic.readers)]) == (
        "g.a.o (name not known)",
        ["sup", "reader"],
    )


def test_what_a_name_was_derived_from_is_remembered_with_its_rules(derived: Derived) -> None:
    memory = DerivedParts()
    architecture = derived(PAIR.replace("WRITER", "publishes: {o: /safety}").replace("READER", "title: R"))
    first = derive_low_level(architecture, memory)
    moved = replace(architecture.nodes["sup"], remaps={"/safety": "/raw"})
    second = derive_low_level(replace(architecture, nodes={**architecture.nodes, "sup": moved}), memory)
    assert [each.name for each in first.endpoints] == ["/safety", "/safety"]
    assert [each.name for each in second.endpoints] == ["/raw", "/raw"]
    third = derive_low_level(architecture, memory)
    assert all(map(lambda ours, theirs: ours is theirs, first.endpoints, third.endpoints))
