"""AADL texts are read section by section, and all that is wrong is told with its place."""

from __future__ import annotations

from fractions import Fraction

import pytest

from archgen.plugins.aadl.aadl_tree import (
    AadlLink,
    AadlList,
    AadlName,
    AadlNumber,
    AadlProperty,
    AadlRange,
    AadlRecord,
    AadlString,
    AadlValue,
)
from archgen.plugins.aadl.package_parsing import parse_text
from archgen.plugins.aadl.token_cursor import END, MAX_DEPTH, scan_tokens
from tests.plugins.aadl.aadl_texts import list_faults, parse_package


def test_tokens_of_a_line() -> None:
    tokens = scan_tokens('a_1 => -16#fF# .. 2.5e3 ms; -- note\n"x""y" {** **')
    kinds = [(token.kind, token.text) for token, _ in zip(tokens, range(12), strict=False)]
    assert kinds == [
        ("name", "a_1"),
        ("sign", "=>"),
        ("sign", "-"),
        ("number", "16#fF#"),
        ("sign", ".."),
        ("number", "2.5e3"),
        ("name", "ms"),
        ("sign", ";"),
        ("text", '"x""y"'),
        ("annex without an end", "{**"),
        (END, ""),
        (END, ""),
    ]


@pytest.mark.parametrize(
    ("written", "value"),
    [
        ("3", AadlNumber(Fraction(3))),
        ("-2.5 ms", AadlNumber(Fraction(-5, 2), "ms")),
        ("16#FF#", AadlNumber(Fraction(255))),
        ("1_000", AadlNumber(Fraction(1000))),
        ("1 ms .. 2 ms", AadlRange(AadlNumber(Fraction(1), "ms"), AadlNumber(Fraction(2), "ms"))),
        ("1 .. 9 delta 2", AadlRange(AadlNumber(Fraction(1)), AadlNumber(Fraction(9)))),
        ('"a ""b"""', AadlString('a "b"')),
        ("Periodic", AadlName("Periodic")),
        ("consts::Slow", AadlName("consts::Slow")),
        ("TRUE", AadlName("TRUE")),
        (
            "(1, (2, 3))",
            AadlList((AadlNumber(Fraction(1)), AadlList((AadlNumber(Fraction(2)), AadlNumber(Fraction(3)))))),
        ),
        ("()", AadlList(())),
        ("[Fixed => 1; Kind => fast;]", AadlRecord({"Fixed": AadlNumber(Fraction(1)), "Kind": AadlName("fast")})),
        ("reference (a.b[2].c)", AadlLink("reference", ("a", "b", "c"))),
        ("classifier (p::q::c.impl)", AadlLink("classifier", ("p::q::c.impl",))),
        ("compute (f)", AadlLink("compute", ("f",))),
    ],
)
def test_values_of_properties(written: str, value: AadlValue) -> None:
    parsed = parse_package(f"data d properties p => {written}; end d;")
    assert parsed.faults == []
    assert parsed.packages[0].classifiers[0].properties[0].value == value


def test_associations_with_all_that_may_follow() -> None:
    text = "s::p +=> constant 1 in modes (m), 2 in modes (n) applies to a.b, c[1].d in binding (memory m::r);"
    found: AadlProperty = parse_package(f"data d properties {text} end d;").packages[0].classifiers[0].properties[0]
    assert (found.name, found.appended, found.modes, found.paths) == ("s::p", True, ("m",), (("a", "b"), ("c", "d")))


def test_a_package_with_all_sections() -> None:
    parsed = parse_text(
        "m.aadl",
        """\
package a::b
public
  with c, d::e;
  short renames package d::e;
  renames c::all;
  renames data c::t;
  annex note {** any ; text end a::b; **};
  feature group fg
    features
      x: in data port;
      y: out event data port c::t [3] {Queue_Size => 2;};
    inverse of other
  end fg;
  thread t extends short::base (m => data c::t, n => (data c::t, data c::t))
    prototypes
      m: data;
      n: refined to in event port;
    features
      p: refined to in out event data port m;
      q: provides subprogram access s;
      r: requires data access c::t;
      g: feature group inverse of fg;
      f: in feature;
    flows
      go: flow path p -> g.x {Latency => 1 ms .. 2 ms;};
      out_of: flow source p;
    modes
      one: initial mode;
      two: mode;
      one -[p, q.r]-> two;
    properties
      Period => 1 ms;
    annex behavior {** states **};
  end t;
  thread implementation t.i
    subcomponents
      d: data c::t.i (x => data c::t) [2][n] in modes (one);
      s: subprogram;
    calls
      main: { f: subprogram s; g: subprogram spg.h {Period => 1 ms;}; } in modes (one);
    connections
      c1: data access s.x <-> r {Timing => immediate;} in modes (one, one);
      port p -> g.x;
      feature group g <-> d.g;
      c2: refined to port {Timing => immediate;};
    flows
      go: flow path p -> c1 -> g.x;
      all_of_it: end to end flow s.f -> c1 -> d;
  end t.i;
private
  data hidden end hidden;
properties
  Source_Text => ("a");
end a::b;

property set ps is
  with c;
  Speed: type aadlinteger 0 .. 100 units (slow, fast => slow * 10);
  Kind: type enumeration (a, b);
  Box: type record (x: aadlinteger; y: list of aadlstring;);
  Top: constant aadlinteger units Time_Units => 9 ms;
  Rate: inherit ps::Speed => 4 slow applies to (thread, in event port, {emv2}**error);
  Any: list of range of aadlreal 0.0 .. 1.0 applies to (all);
  Which: classifier (process implementation) applies to (process);
end ps;
""",
    )
    assert parsed.faults == []
    [package] = parsed.packages
    assert [name for name, _ in package.uses] == ["c", "d::e"]
    assert package.renames == {"short": "d::e", "*c": "c", "t": "c::t"}
    assert [(entry.category, entry.name) for entry in package.classifiers] == [
        ("feature group", "fg"),
        ("thread", "t"),
        ("thread", "t.i"),
        ("data", "hidden"),
    ]
    thread, implementation = package.classifiers[1:3]
    assert [(port.name, port.direction, port.kind, port.classifier) for port in thread.features] == [
        ("p", "in out", "event data port", "m"),
        ("q", "provides", "subprogram access", "s"),
        ("r", "requires", "data access", "c::t"),
        ("g", "", "feature group", "fg"),
        ("f", "in", "feature", ""),
    ]
    assert thread.bindings["n"].classifier == "c::t"
    assert thread.modes == ["one", "two"]
    assert [(entry.name, entry.kind, entry.source, entry.target) for entry in implementation.connections] == [
        ("c1", "data access", ("s", "x"), ("r",)),
        ("", "port", ("p",), ("g", "x")),
        ("", "feature group", ("g",), ("d", "g")),
        ("c2", "port", (), ()),
    ]
    assert implementation.subcomponents[0].dimensions == ("2", "n")
    assert [flow.kind for flow in implementation.flows] == ["path", "end to end"]
    [found] = parsed.property_sets
    assert (list(found.types), list(found.constants), list(found.properties)) == (
        ["speed", "kind", "box"],
        ["top"],
        ["rate", "any", "which"],
    )


@pytest.mark.parametrize(
    ("text", "faults"),
    [
        ("", []),
        ("hello", ["1:1 a package or a property set is missing here"]),
        ("package p\npublic\n", ["3:1 `end p;` is missing before the end of the file"]),
        ("package p public end q;", ["1:18 this ends `q`, but what is open is package `p`"]),
        (
            "package p public\ndata a\nend b;\nend p;",
            ["3:1 this ends `b`, but what is open is `a`"],
        ),
        (
            "package p public\ndata a\nfeatures\n  x: data port;\n  y in data port;\n  port: in event port;\nend a;\nend p;",
            [
                "4:6 a port has a direction: `in`, `out` or `in out`",
                "5:5 `:` is missing here, before `in`",
                "6:3 `port` is a word of AADL, and no name of a feature",
            ],
        ),
        (
            "package p public\ndata a\nproperties\n  x => ;\n  y => (1, ;\n  z => 1 ms\nend a;\nend p;",
            [
                "4:8 a value is missing here",
                "5:12 a value is missing here",
                "7:1 `;` is missing here, before `end`",
            ],
        ),
        ("package p public\ndata a\nwrong\nend a;\nend p;", ["3:1 no section of a data begins with `wrong`"]),
        ("package p public\nannex x {** half", ["2:9 `none` is missing here, before an annex without its end `**}`"]),
        ('package p public\ndata a properties s => "half; end a;', ["2:24 a value is missing here"]),
        (
            f"package p public data a properties x => {'(' * 100};end a; end p;",
            [f"1:{41 + MAX_DEPTH} this stands more than {MAX_DEPTH} levels deep"],
        ),
        (
            f"package p public data a properties x => 1e{'9' * 30}; end a; end p;",
            ["1:41 this is no number that can be read"],
        ),
    ],
)
def test_faults_are_told_with_their_places(text: str, faults: list[str]) -> None:
    assert list_faults(text)[: len(faults) or None] == faults


def test_reading_goes_on_behind_each_fault() -> None:
    parsed = parse_package(
        "data a features x: wrong; end a;\nthread t features ok: in data port; bad; also: out data port; end t;\ndata b end b;"
    )
    assert [entry.name for entry in parsed.packages[0].classifiers] == ["a", "t", "b"]
    assert [port.name for port in parsed.packages[0].classifiers[1].features] == ["ok", "also"]
    assert len(parsed.faults) == 2


def test_words_count_in_any_case() -> None:
    parsed = parse_text("m.aadl", "PACKAGE P PUBLIC Data D End d; END p;")
    assert (parsed.faults, [entry.name for entry in parsed.packages[0].classifiers]) == ([], ["D"])


def test_what_stands_in_no_package_is_read() -> None:
    parsed = parse_text("m.aadl", "data d end d;\nthread t end t;")
    assert parsed.faults == []
    assert parsed.unpackaged is not None
    assert [entry.name for entry in parsed.unpackaged.classifiers] == ["d", "t"]
