"""What the three middlewares make of names that fall together, servers that differ, types of others, and deep or wide projects."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from archgen.diagnostics.diagnostic import Severity
from archgen.products.output_options import OutputOptions
from archgen.products.workspace_product import WorkspaceRequest, write_workspace
from tests.outside_tools import find_tool, run_judge
from tests.plugins.middlewares.middleware_projects import STAND_INS, generate, write_project
from tests.plugins.middlewares.test_middlewares import MIDDLEWARES, compile_middleware
from tests.running import contents

NAMES = """
    camera camera_behaviour camera_servant library types typekit transport main plugin encoding values parameters message device
    driver property peer config_file std operations services timed calls wait publish rtc corba pre_operational
    """.split()  # noqa: SIM905 - a list of words
TYPES = "".join(
    f"  {name}: {{outputs: {{o: T}}, inputs: {{i: T}}, operations: {{get_x: T, set_y: {{request: {{a: T}}}}}}, parameters: {{x: 1}}}}\n"
    for name in NAMES
)
INSTANCES = "".join(f"      i{number}: {{is: {name}, inputs: {{i: i0.o}}}}\n" for number, name in enumerate(NAMES))
HOUSE_NAMES = f"""\
archgen: 1
project: {{id: timed}}
types: {{T: geometry_msgs/msg/Point, U: {{message: timed/msg/U, fields: {{x: {{type: int8}}}}}}, V: {{message: encoding/msg/V, fields: {{u: {{type: U}}}}}}}}
component_types:
{TYPES}
groups:
  g:
    components:
      own: {{outputs: {{u: U, v: V}}, operations: {{set_all: {{request: {{a: int8, b: int8, c: int8, d: int8, e: V}}}}}}}}
{INSTANCES}"""
"""Components, a project and packages that are called as what the generators make themselves."""
ASK = "types: {Ask: {message: p_msgs/srv/Ask, request: {a: {type: int8}}, response: {b: {type: int8}}}}\n"


@pytest.mark.parametrize("middleware", MIDDLEWARES)
def test_names_of_the_generators_own_files_and_classes_are_free(middleware: str, tmp_path: Path) -> None:
    assert generate(write_project(tmp_path / "p", HOUSE_NAMES), tmp_path / "w", middleware) == []
    own = {each.name for each in (tmp_path / "w" / middleware / "src").glob("*_behaviour.cpp")}
    assert {"camera_behaviour.cpp", "camera_behaviour__behaviour.cpp", "types__behaviour.cpp"} <= own


@pytest.mark.build
@pytest.mark.parametrize("middleware", MIDDLEWARES)
def test_names_of_the_generators_own_files_and_classes_compile(middleware: str, tmp_path: Path) -> None:
    generate(write_project(tmp_path / "p", HOUSE_NAMES), tmp_path / "w", middleware)
    assert compile_middleware(tmp_path / "w", middleware, tmp_path) == ""


def test_an_input_that_would_be_called_as_an_output_is_told(tmp_path: Path) -> None:
    text = (
        "archgen: 1\ntypes: {T: {fields: {x: {type: int8}}}}\ngroups: {g: {components: {"
        "a: {outputs: {x: T, x_input: T}, inputs: {x: {type: T, external: Somebody}}}, b: {inputs: {y: a.x_input}, outputs: {}}}}}\n"
    )
    assert generate(write_project(tmp_path / "p", text), tmp_path / "w", "player") == [
        "`g.a.x_input` and `g.a.x` give the same name `x_input`"
    ]


@pytest.mark.parametrize(
    ("components", "told"),
    [
        (
            "s: {outputs: {ask: Ask}}, t: {outputs: {ask: Ask}}, c: {inputs: {ask: [s.ask, t.ask]}}",
            "`g.c.ask` does not call `g.t.ask`: it calls another one already",
        ),
        (
            "s: {outputs: {ask: Ask}}, t: {outputs: {ask: Ask}}, c: {is: client, inputs: {ask: s.ask}}, d: {is: client, inputs: {ask: t.ask}}",
            "`g.d.ask` does not call `g.t.ask`: all instances of its type call one of the class `GS`",
        ),
        (
            "s: {outputs: {ask_it: Ask}, operations: {Ask_it: {}}}, c: {inputs: {ask: s.ask_it}}",
            "`g.c.ask` is left out: what it calls, `g.s.ask_it`, is left out",
        ),
    ],
)
def test_calls_that_cannot_be_joined_are_told(components: str, told: str, tmp_path: Path) -> None:
    text = f"archgen: 1\n{ASK}component_types: {{client: {{inputs: {{ask: Ask}}}}}}\ngroups: {{g: {{components: {{{components}}}}}}}\n"
    assert generate(write_project(tmp_path / "p", text), tmp_path / "w", "orocos")[-1] == told


def test_a_fault_of_a_part_that_nobody_asked_for_is_not_told(tmp_path: Path) -> None:
    text = f"""\
archgen: 1
{ASK}hosts: {{one: {{}}, two: {{}}}}
groups: {{g: {{components: {{s: {{outputs: {{ask: Ask}}}}, t: {{outputs: {{ask: Ask}}}}, c: {{inputs: {{ask: [s.ask, t.ask]}}}}}}}}}}
nodes: {{s: {{implements: g.s, host: one}}, c: {{implements: g.c, host: two}}}}
"""
    project = write_project(tmp_path / "p", text)
    assert generate(project, tmp_path / "one", "orocos", WorkspaceRequest(host="one")) == []
    assert len(generate(project, tmp_path / "two", "orocos", WorkspaceRequest(host="two"))) == 1


def test_types_of_others_count_for_operations_and_for_what_is_only_sent(tmp_path: Path) -> None:
    text = """\
archgen: 1
project: {id: p}
types: {Frame: {hints: {orocos: {type: 'KDL::Frame', header: kdl/frames.hpp, typekit: kdl_typekit}}}}
groups:
  g:
    components:
      a: {operations: {get_frame: Frame, set_all: {request: {a: Frame, b: int8, c: int8, d: int8, e: int8}}}}
      b: {outputs: {at: Frame}}
"""
    assert generate(write_project(tmp_path / "p", text), tmp_path / "w", "orocos") == []
    files = {path: data.decode() for path, data in contents(tmp_path / "w" / "orocos").items()}
    assert "KDL::Frame serve_get_frame();" in files["include/p/g_a_behaviour.hpp"]
    for name in ("g_a", "g_b"):
        assert "#include <kdl/frames.hpp>" in files[f"include/p/{name}.hpp"]
    # No header stands before the records, which hold nothing of others.
    assert "KDL" not in files["include/p/types.hpp"]
    for name in ("cpf", "lua"):
        assert "kdl_typekit" in files[f"deployment/no_host.{name}"]


def test_types_of_which_nobody_says_the_fields_are_told_once_where_they_are_written(tmp_path: Path) -> None:
    text = """\
archgen: 1
types:
  PubData: {}
  Own: {message: p_msgs/msg/Own, fields: {held: {type: elsewhere_msgs/msg/Held}}}
  Of others: {hints: {orocos: {type: 'KDL::Frame'}}}
  Answer: {}
groups:
  g:
    components:
      a: {outputs: {data: PubData, list: "PubData[]", own: Own, of_others: Of others, text: string}, operations: {get: Answer}}
      b: {inputs: {data: a.data}, outputs: {}}
"""
    result = write_workspace(
        write_project(tmp_path / "p", text), OutputOptions(), "orocos", tmp_path / "w", WorkspaceRequest()
    )
    told = [(each.severity, each.span.line, each.message.partition(":")[0]) for each in result.findings]
    assert sorted(told, key=lambda each: each[1]) == [
        (Severity.NOTE, 3, "nobody says the fields of `PubData`"),
        (Severity.NOTE, 4, "nobody says the fields of `elsewhere_msgs/msg/Held`"),
        (Severity.NOTE, 6, "nobody says the fields of `Answer`"),
    ]


def test_messages_that_hold_one_another_deeply_are_records(tmp_path: Path) -> None:
    depth = 1200
    texts = "".join(f'    p_msgs/msg/M{each}: "p_msgs/M{each + 1} below"\n' for each in range(depth))
    text = (
        f"archgen: 1\nproject: {{id: robot}}\nros:\n  definitions:\n{texts}    p_msgs/msg/M{depth}: int8 x\ntypes: {{Tree: p_msgs/msg/M0}}\n"
        "groups: {g: {components: {a: {outputs: {tree: Tree}}}}}\n"
    )
    assert generate(write_project(tmp_path / "p", text), tmp_path / "w", "orocos") == []
    header = (tmp_path / "w" / "orocos" / "include" / "robot" / "types.hpp").read_text("utf-8")
    assert header.count("struct M") == depth + 1
    assert header.index("struct M2\n") < header.index("struct M1\n")


def test_messages_in_a_circle_are_cut_where_they_close(tmp_path: Path) -> None:
    text = """\
archgen: 1
ros: {definitions: {p_msgs/msg/A: "p_msgs/B[] b\\nint8 x", p_msgs/msg/B: "p_msgs/A[] a\\nint8 y"}}
types: {A: p_msgs/msg/A, B: p_msgs/msg/B}
groups: {g: {components: {a: {outputs: {one: A, two: B}}}}}
"""
    assert generate(write_project(tmp_path / "p", text), tmp_path / "w", "orocos") == [
        "the field `a` of `p_msgs/msg/B` is left out: by it `p_msgs/msg/B` would hold itself"
    ]


def test_a_period_of_openrtm_is_that_of_the_only_context(tmp_path: Path) -> None:
    """`execution_contexts: Type(25.0)` makes a context called 25.0, which runs a million times a second."""
    text = "archgen: 1\ngroups: {g: {components: {a: {outputs: {}, timing: {rate: 25 Hz}}}}}\n"
    generate(write_project(tmp_path / "p", text), tmp_path / "w", "openrtm")
    lines = (tmp_path / "w" / "openrtm" / "config" / "g_a.conf").read_text("utf-8").splitlines()
    assert "exec_cxt.periodic.rate: 25.0" in lines
    assert not [line for line in lines if line.startswith("execution_contexts")]


def test_records_travel_between_computers_in_orocos(tmp_path: Path) -> None:
    text = """\
archgen: 1
project: {id: p}
types: {T: {fields: {x: {type: int64}, list: {type: "uint8[]"}}}, Ask: {message: p_msgs/srv/Ask, request: {a: {type: int8}}}}
hosts: {one: {}, two: {}}
groups: {g: {components: {a: {outputs: {t: T, start: Ask}}, b: {inputs: {t: a.t, start: a.start}}}}}
nodes: {a: {implements: g.a, host: one}, b: {implements: g.b, host: two}}
"""
    generate(write_project(tmp_path / "p", text), tmp_path / "w", "orocos")
    files = {path: data.decode() for path, data in contents(tmp_path / "w" / "orocos").items()}
    for name in ("/p/p_msgs/T", "/p/p_msgs/T[]", "/p/list_of_Octet", "/p/int64_t"):
        assert f'"{name}"' in files["src/typekit.cpp"]
        assert f'if (name == "{name}")' in files["src/transport.cpp"]
    assert 'type="CORBA"' not in files["deployment/one.cpf"]
    assert '<struct name="g_a" type="CORBA">' in files["deployment/two.cpf"]
    # `connectOperations` of the deployer takes only what its own program has.
    assert 'g_b.join_start_("g_a", "start_");' in files["deployment/two.ops"]
    assert "&GB::join_start, this, RTT::ClientThread" in files["src/g_b.cpp"]


def test_what_joins_a_call_replaces_no_operation(tmp_path: Path) -> None:
    """RTT keeps the later one of two operations of a name."""
    text = (
        f"archgen: 1\n{ASK}groups: {{g: {{components: {{s: {{outputs: {{ask: Ask}}}},"
        " c: {inputs: {ask: s.ask}, operations: {join_ask: {}, join_ask_: {}}}}}}\n"
    )
    generate(write_project(tmp_path / "p", text), tmp_path / "w", "orocos")
    names = re.findall(r'addOperation\("(\w+)"', (tmp_path / "w" / "orocos" / "src" / "g_c.cpp").read_text("utf-8"))
    assert sorted(names) == ["join_ask", "join_ask_"]


MANY = """\
archgen: 1
project: {id: p}
ros: {definitions: {q_msgs/msg/None: "", q_msgs/msg/Many: "q_msgs/None[] nothing\\nstring[] texts\\nbool[] truths\\nint16[] numbers"}}
types: {Many: q_msgs/msg/Many}
groups: {g: {components: {a: {outputs: {many: Many}}}}}
"""
ROUND_TRIP = """\
#include "p/%s"
int main() {
  p::q_msgs::Many sent;
  sent.nothing.resize(3);
  sent.texts = {"a", "", "bcd"};
  sent.truths = {true, false};
  sent.numbers = {1, -2};
  p::encoding::Writer writer;
  %s;
  %s;
  for (std::size_t size = 0; size <= writer.bytes.size(); ++size) {
    p::q_msgs::Many read;
    p::encoding::Reader reader{writer.bytes.data(), size, true};
    %s;
    %s;
    const bool is_equal = read.nothing.size() == 3 && read.texts == sent.texts && read.truths == sent.truths && read.numbers == sent.numbers;
    if (reader.is_good != (size == writer.bytes.size()) || (reader.is_good && !is_equal)) {
      return 1;
    }
  }
  return 0;
}
"""
"""A record, and behind it a list of what takes no bytes; what is cut short anywhere is refused."""


@pytest.mark.build
@pytest.mark.parametrize(
    ("middleware", "header", "put", "get"),
    [
        ("orocos", "serialization.hpp", "writer.put({})", "reader.get({})"),
        ("player", "encoding.hpp", "p::encoding::put(writer, {})", "p::encoding::get(reader, {})"),
    ],
    ids=("orocos", "player"),
)
def test_what_is_written_as_bytes_is_read_again(
    middleware: str, header: str, put: str, get: str, tmp_path: Path
) -> None:
    generate(write_project(tmp_path / "p", MANY), tmp_path / "w", middleware)
    calls = (
        each.format(name) for each, name in ((put, "sent"), (put, "sent.nothing"), (get, "read"), (get, "read.nothing"))
    )
    (tmp_path / "main.cpp").write_text(ROUND_TRIP % (header, *calls), "utf-8")
    folders = (tmp_path / "w" / middleware / "include", STAND_INS / middleware)
    words = ("-std=c++14", *(f"-I{each}" for each in folders), "main.cpp", "-o", "main")
    run_judge(find_tool("g++"), *words, cwd=tmp_path)
    run_judge(tmp_path / "main")
