"""What outputs promise as the model has it: read, laid over types, given on by composed components."""

from __future__ import annotations

from fractions import Fraction
from pathlib import Path

import pytest

from archgen.diagnostics.source_span import NO_SPAN
from archgen.link.promise_reading import read_promise
from archgen.model.architecture import Architecture
from archgen.model.component import Output
from archgen.pipeline import check_project
from archgen.syntax.yaml_tree import MappingNode


def declared(folder: Path, text: str) -> Architecture:
    (folder / "robot.yaml").write_text(text, encoding="utf-8")
    checked = check_project(folder / "robot.yaml")
    assert not checked.structural_errors, [each.message for each in checked.structural_errors]
    return checked.architecture


def output(architecture: Architecture, output_id: str) -> Output:
    component = architecture.find_component(output_id.rpartition(".")[0])
    assert component
    return component.outputs[output_id.rpartition(".")[2]]


def kept(port: Output) -> dict[str, str]:
    return {key: str(value) for key, value in port.promise.list_kept()} if port.promise else {}


def test_nothing_is_promised_where_nothing_is_written() -> None:
    assert read_promise(MappingNode({}, NO_SPAN), "g.a", []) is None


def test_all_that_a_promise_says(tmp_path: Path) -> None:
    architecture = declared(
        tmp_path,
        "groups: {g: {components: {a: {outputs: {o: {promise: {rate: 0.5 kHz, max_gap: 150 ms, max_age: 1 s, unit: m, "
        "frame: base, range: [-.5, 1e3]}, version: 1.10, deprecated: {until: 2999-01-01, use: p}}, p: {promise: {range: [-3 m/s, .inf]}}}}}}}\n",
    )
    port, other = output(architecture, "g.a.o"), output(architecture, "g.a.p")
    assert port.promise
    assert port.promise.rate
    assert port.promise.max_gap
    assert port.promise.rate.value == Fraction(500)
    assert port.promise.max_gap.value == 150_000_000
    assert (port.promise.unit, port.promise.frame, port.promise.range) == ("m", "base", (-0.5, 1000.0))
    assert port.version == "1.10"
    assert port.deprecated
    assert (port.deprecated.until, port.deprecated.use, port.deprecated.target) == ("2999-01-01", "p", "g.a.p")
    assert other.promise
    assert (other.promise.unit, other.promise.range) == ("m/s", (-3, float("inf")))


TYPES = """\
component_types:
  motor:
    parameters: {prefix: {type: string, value: left_}}
    outputs:
      o: {type: T, promise: {rate: 10 Hz, unit: m, frame: $(self.prefix)base}, version: 1, deprecated: {use: p}}
      p: T
  strong: {is: motor, version: 2, outputs: {o: {promise: {rate: 20 Hz}}}}
groups:
  g:
    components:
      a: {is: motor}
      b: {is: strong, parameters: {prefix: right_}, outputs: {o: {promise: {unit: cm}, version: 3}}}
"""


def test_an_instance_lays_over_its_type_leaf_by_leaf(tmp_path: Path) -> None:
    architecture = declared(tmp_path, TYPES)
    first, second = output(architecture, "g.a.o"), output(architecture, "g.b.o")
    assert kept(first) == {"rate": "10 Hz", "unit": "m", "frame": "left_base"}
    assert kept(second) == {"rate": "20 Hz", "unit": "cm", "frame": "right_base"}
    assert (first.version, second.version) == ("1", "3")
    assert second.deprecated
    assert second.deprecated.target == "g.b.p"
    # The version of a type is its own: neither its instances nor the types made from it have it.
    assert architecture.component_types["strong"].version == "2"
    assert architecture.component_types["motor"].version is None


SHELLS = """\
groups:
  g:
    components:
      outer:
        outputs: {o: {from: inner.o}, q: {from: inner.q}, own: {from: inner.o, promise: {rate: 5 Hz, range: [0, 1]}, version: 9}}
        components:
          inner:
            outputs: {o: {from: leaf.o, promise: {max_age: 1 s}}, q: {from: leaf.p}, both: {from: [leaf.o, leaf.p]}, echo: {from: self.x}}
            inputs: {x: g.far.o}
            components:
              leaf: {outputs: {o: {promise: {rate: 10 Hz, unit: m}, version: 1, deprecated: {use: p}}, p: {promise: {rate: 10 Hz, unit: cm}, version: 1}}}
      far: {outputs: {o: {promise: {rate: 7 Hz}}}}
"""


def test_what_is_given_on_is_kept_unless_something_else_is_written(tmp_path: Path) -> None:
    architecture = declared(tmp_path, SHELLS)
    assert kept(output(architecture, "g.outer.o")) == {"rate": "10 Hz", "max_age": "1 s", "unit": "m"}
    assert kept(output(architecture, "g.outer.inner.o")) == {"rate": "10 Hz", "max_age": "1 s", "unit": "m"}
    # The unit is that of the values whose range is written.
    assert kept(output(architecture, "g.outer.own")) == {"rate": "5 Hz", "max_age": "1 s", "range": "(0, 1)"}
    assert (output(architecture, "g.outer.o").version, output(architecture, "g.outer.own").version) == ("1", "9")
    # What several outputs promise alike, and what comes in through an input.
    assert kept(output(architecture, "g.outer.inner.both")) == {"rate": "10 Hz"}
    assert output(architecture, "g.outer.inner.both").deprecated is None
    assert kept(output(architecture, "g.outer.inner.echo")) == {"rate": "7 Hz"}


@pytest.mark.parametrize(
    ("port", "target"),
    [
        ("g.outer.inner.leaf.o", "g.outer.inner.leaf.p"),
        ("g.outer.inner.o", "g.outer.inner.q"),
        ("g.outer.o", "g.outer.q"),
    ],
)
def test_what_replaces_something_given_on_is_the_port_that_gives_the_replacement_on(
    tmp_path: Path, port: str, target: str
) -> None:
    deprecated = output(declared(tmp_path, SHELLS), port).deprecated
    assert deprecated
    assert deprecated.target == target


def test_outputs_that_give_one_another_on_promise_nothing_and_end(tmp_path: Path) -> None:
    (tmp_path / "robot.yaml").write_text(
        "groups: {g: {components: {a: {inputs: {x: b.o}, outputs: {o: {from: self.x}}, components: {i: {outputs: {z: T}}}}, "
        "b: {inputs: {x: a.o}, outputs: {o: {from: self.x, version: 2}}, components: {i: {outputs: {z: {version: 1}}}}}}}}\n",
        encoding="utf-8",
    )
    architecture = check_project(tmp_path / "robot.yaml").architecture
    assert [output(architecture, name).version for name in ("g.a.o", "g.b.o")] == ["2", "2"]


def test_two_thousand_outputs_that_pass_on_take_no_recursion(tmp_path: Path) -> None:
    names = range(2_000)
    parts = ", ".join(
        f"c{n}: {{inputs: {{x: c{n - 1}.o}}, outputs: {{o: {{from: self.x}}}}, components: {{i: }}}}"
        for n in names
        if n
    )
    architecture = declared(
        tmp_path, f"groups: {{g: {{components: {{c0: {{outputs: {{o: {{version: 1}}}}}}, {parts}}}}}}}\n"
    )
    assert output(architecture, "g.c1999.o").version == "1"
