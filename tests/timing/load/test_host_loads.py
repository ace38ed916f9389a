"""Hosts: load, verdict and bounds; every tier of a response."""

from __future__ import annotations

import pytest

from tests.timing.printed import show_ms
from tests.timing.sketches import analyse_sketch, list_hosts, list_reasons, list_responses


def test_each_tier_and_each_verdict() -> None:
    """c: 10 + 5 + 2 x 2 = 19, before b comes again at 20. k: 4 + (2 x 3 + 6 + 6) / 2 = 13,
    for within 13 come two of l and one of m, and one thread was busy before: at most with one more of m. l: 3 + (2 x 4 + 6 + 6) / 2.
    m: 6 + (2 x 4 + 2 x 3 + 4) / 2 = 15. n (2^(1/n) - 1) is 0.8284 for 2, 0.7797 for 3.
    """
    analysis = analyse_sketch(
        {
            "a @pc": "period: 10 ms, wcet: 2 ms, priority: 3",
            "b @pc": "period: 20 ms, wcet: 5 ms, priority: 2",
            "c @pc": "period: 50 ms, wcet: 10 ms, priority: 1",
            "d @free": "period: 10 ms, wcet: 4 ms",
            "e @free": "period: 20 ms, wcet: 6 ms",
            "f @full": "period: 10 ms, wcet: 10 ms, priority: 1",
            "g @over": "period: 10 ms, wcet: 11 ms",
            "h @open": "period: 10 ms",
            "i @open": "period: 10 ms, wcet: 1 ms, priority: 9",
            "j @open": "period: 10 ms, wcet: 2 ms",
            "k @many": "period: 10 ms, wcet: 4 ms",
            "l @many": "period: 10 ms, wcet: 3 ms",
            "m @many": "period: 20 ms, wcet: 6 ms",
            "nn @nobody": "period: 4 ms, wcet: 1 ms, response: 3 ms",
            "o": "period: 5 ms, wcet: 2 ms",
            "p @pinned": "period: 10 ms, wcet: 2 ms, core: 0",
            "q @pinned": "period: 10 ms, wcet: 3 ms",
            "r @pinned": "period: 10 ms, wcet: 4 ms",
            "s +box": "period: 10 ms, wcet: 2 ms",
            "t +box": "period: 20 ms, wcet: 3 ms",
        },
        "",
        "hosts: {pc: {cores: 1}, free: {cores: 1}, full: {cores: 1}, over: {cores: 1}, open: {cores: 1}, many: {cores: 2}, nobody: {}, pinned: {cores: 2}, one: {cores: 1}, empty: {cores: 4}}\n"
        "containers: {box: {threads: 1, host: one}}",
    )
    assert list_responses(analysis) == [
        "a none ?a..2 priorities",
        "b none ?b..7 priorities",
        "c none ?c..19 priorities",
        "d none ?d..10 host",
        "e none ?e..10 host",
        "f none ?f..10 priorities",
        "g none ?g..none [overload] host",
        "h none ?h..>= none ?h unknown",
        "i none ?i..1 priorities",
        "j none ?j..>= 2 ?h host",
        "k none ?k..13 cores",
        "l none ?l..13 cores",
        "m none ?m..15 cores",
        "nn none ?nn..3 [assumed] declared",
        "o none ?o..2 [assuming a dedicated core] dedicated",
        "p none ?p..2 host",
        "q none ?q..7 [cores to which something is pinned are kept for it] host",
        "r none ?r..7 [cores to which something is pinned are kept for it] host",
        "s none ?s..5 executor",
        "t none ?t..5 executor",
    ]
    assert list_reasons(analysis) == [
        "a: every 10 ms, as written @25:49",
        "b: every 20 ms, as written @26:49",
        "c: every 50 ms, as written @27:49",
        "d: every 10 ms, as written @28:51",
        "e: every 20 ms, as written @29:51",
        "f: every 10 ms, as written @30:51",
        "g: every 10 ms, as written @31:51",
        "h: every 10 ms, as written @32:51",
        "i: every 10 ms, as written @33:51",
        "j: every 10 ms, as written @34:51",
        "k: every 10 ms, as written @35:51",
        "l: every 10 ms, as written @36:51",
        "m: every 20 ms, as written @37:51",
        "nn: every 4 ms, as written @38:55",
        "o: every 5 ms, as written @39:39",
        "p: every 10 ms, as written @40:53",
        "q: every 10 ms, as written @41:53",
        "r: every 10 ms, as written @42:53",
        "s: every 10 ms, as written @43:55",
        "t: every 20 ms, as written @44:55",
        "a takes: everything of its priority or a higher one on pc, over all activations of the busy period @25:62",
        "b takes: everything of its priority or a higher one on pc, over all activations of the busy period @26:62",
        "c takes: everything of its priority or a higher one on pc, over all activations of the busy period @27:62",
        "d takes: the longest time for which all work on free can keep it busy, in whatever order @28:64",
        "e takes: the longest time for which all work on free can keep it busy, in whatever order @29:64",
        "f takes: everything of its priority or a higher one on full, over all activations of the busy period @30:64",
        "g takes: the longest time for which all work on over can keep it busy, in whatever order @31:64",
        "h takes: no execution time is written @32:34",
        "i takes: everything of its priority or a higher one on open, over all activations of the busy period @33:64",
        "j takes: the longest time for which all work on open can keep it busy, in whatever order @34:64",
        "k takes: all work of its own thread, and a share of all other work on the 2 cores of many @35:64",
        "l takes: all work of its own thread, and a share of all other work on the 2 cores of many @36:64",
        "m takes: all work of its own thread, and a share of all other work on the 2 cores of many @37:64",
        "nn takes: declared as the worst case @38:83 | waits for 2 ms in its callback, as its `response` says, and keeps its thread @38:83",
        "o takes: its own queue, on a core of its own @39:51",
        "p takes: the longest time for which all work on pinned core 0 can keep it busy, in whatever order @40:66",
        "q takes: the longest time for which all work on pinned can keep it busy, in whatever order @41:66",
        "r takes: the longest time for which all work on pinned can keep it busy, in whatever order @42:66",
        "s takes: all work of its executor on one, in whatever order @43:68",
        "t takes: all work of its executor on one, in whatever order @44:68",
    ]
    assert list_hosts(analysis) == [
        "pc: 13/20 of 1: schedulable; rm 779763147/1000000000, edf 1",
        "  pc (1) 13/20",
        "  a 1/5, b 1/4, c 1/5",
        "free: 7/10 of 1: schedulable; rm 207106781/250000000, edf 1",
        "  free (1) 7/10",
        "  d 2/5, e 3/10",
        "full: 1 of 1: schedulable; rm 1, edf 1",
        "  full (1) 1",
        "  f 1",
        "over: 11/10 of 1: overload; rm 1, edf 1",
        "  over (1) 11/10",
        "  g 11/10",
        "open: >= 3/10 ?h of 1: unknown; rm 779763147/1000000000, edf 1",
        "  open (1) >= 3/10 ?h",
        "  h none ?h, i 1/10, j 1/5",
        "many: 1 of 2: undecided; rm none [one core only], edf none [one core only]",
        "  many (2) 1",
        "  k 2/5, l 3/10, m 3/10",
        "nobody: 1/4 of 1: schedulable; rm 1, edf 1",
        "  nobody (1) 1/4",
        "  nn 1/4",
        "pinned: 9/10 of 2: schedulable; rm none [one core only], edf none [one core only]",
        "  pinned core 0 (1) 1/5, pinned (1) 7/10",
        "  p 1/5, q 3/10, r 2/5",
        "one: 7/20 of 1: schedulable; rm 207106781/250000000, edf 1",
        "  one (1) 7/20",
        "  s 1/5, t 3/20",
        "empty: 0 of 4: schedulable; rm none [one core only], edf none [one core only]",
        "  ",
        "  ",
    ]


def test_what_a_verdict_rests_on() -> None:
    """Late (1 + 20 + 1 + 1 > 10) but below the bound of Liu and Layland: schedulable, unless priorities are against the rates or
    of some only, or there is jitter.
    """
    analysis = analyse_sketch(
        {
            "a @low": "period: 10 ms, wcet: 1 ms",
            "b @low": "period: 100 ms, wcet: 20 ms",
            "c @turned": "period: 10 ms, wcet: 1 ms, priority: 1",
            "d @turned": "period: 100 ms, wcet: 20 ms, priority: 2",
            "e @mixed": "period: 10 ms, wcet: 1 ms",
            "f @mixed": "period: 100 ms, wcet: 20 ms, priority: 1",
            "g @shaky": "period: 10 ms, wcet: 1 ms",
            "h @shaky": "period: 100 ms, wcet: 20 ms, jitter: 1 ms",
            "i @high": "period: 10 ms, wcet: 4 ms",
            "j @high": "period: 100 ms, wcet: 50 ms",
            "k @rated": "period: 10 ms, wcet: 1 ms, response: 11 ms, priority: 2",
            "l @rated": "period: 20 ms, wcet: 5 ms, priority: 1",
            "m @rest": "period: 10 ms, wcet: 0 ms, jitter: 5 ms",
            "o @rest": "behaviour: once, wcet: 3 ms",
            "p @rest": "period: 30 ms, wcet: 3 ms, response: 40 ms",
            "q @brim": "period: 10 ms, wcet: 5 ms",
            "r @brim": "period: 10 ms, wcet: 5 ms",
            "s @brim2": "period: 10 ms, wcet: 5 ms, priority: 2",
            "t @brim2": "period: 20 ms, wcet: 10 ms, priority: 1",
            "u @dark": "period: 10 ms, wcet: 10 ms",
            "v @dark": "period: 10 ms",
            "w @equal": "period: 10 ms, wcet: 1 ms, response: 11 ms, priority: 5",
            "x @equal": "period: 20 ms, wcet: 4 ms, priority: 5",
            "y @slow": "period: 10 ms, wcet: 1 ms, response: 10 ms",
            "z @fed": "behaviour: event, wcet: 1 ms",
            "aa @duo": "period: 10 ms, wcet: 1 ms, response: 11 ms, core: 0",
            "bb @duo": "period: 10 ms, wcet: 1 ms",
            "cc @free": "period: 10 ms, wcet: 1 ms, response: 11 ms",
            "dd @free": "period: 20 ms, wcet: 5 ms, priority: 3",
            "ee @just": "period: 10 ms, wcet: 5 ms, response: 11 ms",
            "ff @just": "period: 10 ms, wcet: 3284271 ns",
            "gg @above": "period: 10 ms, wcet: 5 ms, response: 11 ms",
            "hh @above": "period: 10 ms, wcet: 3284272 ns",
            "ring @loop": "wcet: 1 ms",
            "back @loop": "wcet: 1 ms",
            "cast @hot": "wcet: 1 ms",
        },
        "ring>back back>ring ring>cast",
        "hosts: {low: {cores: 1}, turned: {cores: 1}, mixed: {cores: 1}, shaky: {cores: 1}, high: {cores: 1}, rated: {cores: 1}, rest: {cores: 1}, brim: {cores: 1}, brim2: {cores: 1}, dark: {cores: 1}, equal: {cores: 1}, slow: {cores: 1}, fed: {cores: 1}, duo: {cores: 2}, free: {cores: 1}, just: {cores: 1}, above: {cores: 1}, loop: {cores: 1}, hot: {cores: 1}}",
    )
    assert list_responses(analysis) == [
        "a none ?a..23 host",
        "b none ?b..23 host",
        "c none ?c..21 priorities",
        "d none ?d..20 priorities",
        "e none ?e..23 host",
        "f none ?f..20 priorities",
        "g none ?g..23 host",
        "h none ?h..23 host",
        "i none ?i..86 host",
        "j none ?j..86 host",
        "k none ?k..11 [assumed] declared",
        "l none ?l..7 priorities",
        "m none ?m..6 host",
        "o none ?o..9 host",
        "p none ?p..40 [assumed] declared",
        "q none ?q..none [overload] host",
        "r none ?r..none [overload] host",
        "s none ?s..5 priorities",
        "t none ?t..20 priorities",
        "u none ?u..none [overload] host",
        "v none ?v..none ?v [overload] unknown",
        "w none ?w..11 [assumed] declared",
        "x none ?x..6 priorities",
        "y none ?y..10 [assumed] declared",
        "z none ?z..>= 1 ?z host",
        "aa none ?aa..11 [assumed] declared",
        "bb none ?bb..1 [cores to which something is pinned are kept for it] host",
        "cc none ?cc..11 [assumed] declared",
        "dd none ?dd..5 priorities",
        "ee none ?ee..11 [assumed] declared",
        "ff none ?ff..9534271/250000 host",
        "gg none ?gg..11 [assumed] declared",
        "hh none ?hh..595892/15625 host",
        "ring none ?ring..1 host",
        "back none ?back..1 host",
        "cast none ?cast..1 host",
    ]
    assert list_hosts(analysis) == [
        "low: 3/10 of 1: schedulable; rm 207106781/250000000, edf 1",
        "  low (1) 3/10",
        "  a 1/10, b 1/5",
        "turned: 3/10 of 1: undecided; rm 207106781/250000000, edf 1",
        "  turned (1) 3/10",
        "  c 1/10, d 1/5",
        "mixed: 3/10 of 1: undecided; rm 207106781/250000000, edf 1",
        "  mixed (1) 3/10",
        "  e 1/10, f 1/5",
        "shaky: 3/10 of 1: undecided; rm 207106781/250000000, edf 1",
        "  shaky (1) 3/10",
        "  g 1/10, h 1/5",
        "high: 9/10 of 1: undecided; rm 207106781/250000000, edf 1",
        "  high (1) 9/10",
        "  i 2/5, j 1/2",
        "rated: 7/20 of 1: schedulable; rm 207106781/250000000, edf 1",
        "  rated (1) 7/20",
        "  k 1/10, l 1/4",
        "rest: 1/10 of 1: schedulable; rm 1, edf 1",
        "  rest (1) 1/10",
        "  m 0, o 0, p 1/10",
        "brim: 1 of 1: overload; rm 207106781/250000000, edf 1",
        "  brim (1) 1",
        "  q 1/2, r 1/2",
        "brim2: 1 of 1: schedulable; rm 207106781/250000000, edf 1",
        "  brim2 (1) 1",
        "  s 1/2, t 1/2",
        "dark: >= 1 ?v of 1: overload; rm 207106781/250000000, edf 1",
        "  dark (1) >= 1 ?v",
        "  u 1, v none ?v",
        "equal: 3/10 of 1: undecided; rm 207106781/250000000, edf 1",
        "  equal (1) 3/10",
        "  w 1/10, x 1/5",
        "slow: 1/10 of 1: schedulable; rm 1, edf 1",
        "  slow (1) 1/10",
        "  y 1/10",
        "fed: none ?z of 1: unknown; rm 1, edf 1",
        "  fed (1) none ?z",
        "  z none ?z",
        "duo: 1/5 of 2: undecided; rm none [one core only], edf none [one core only]",
        "  duo core 0 (1) 1/10, duo (1) 1/10",
        "  aa 1/10, bb 1/10",
        "free: 7/20 of 1: undecided; rm 207106781/250000000, edf 1",
        "  free (1) 7/20",
        "  cc 1/10, dd 1/4",
        "just: 8284271/10000000 of 1: schedulable; rm 207106781/250000000, edf 1",
        "  just (1) 8284271/10000000",
        "  ee 1/2, ff 3284271/10000000",
        "above: 517767/625000 of 1: undecided; rm 207106781/250000000, edf 1",
        "  above (1) 517767/625000",
        "  gg 1/2, hh 205267/625000",
        "loop: 0 of 1: schedulable; rm 1, edf 1",
        "  loop (1) 0",
        "  ring 0, back 0",
        "hot: 0 of 1: schedulable; rm 1, edf 1",
        "  hot (1) 0",
        "  cast 0",
    ]


@pytest.mark.parametrize(
    ("cores", "loads"),
    [
        # With one core there is nothing to pin; with two, one is kept for what is pinned to it; else nobody knows.
        ("cores: 1", ["  pc (1) 3/10"]),
        ("", ["  "]),
        ("cores: 2", ["  pc core 0 (1) 1/10, pc (1) 1/5"]),
    ],
)
def test_a_pin_needs_a_second_core(cores: str, loads: list[str]) -> None:
    nodes = {"a @pc": "period: 10 ms, wcet: 1 ms, core: 0", "b @pc": "period: 10 ms, wcet: 2 ms"}
    assert list_hosts(analyse_sketch(nodes, "", f"hosts: {{pc: {{{cores}}}}}"))[1:2] == loads


def test_a_thread_with_a_core_of_its_own_says_so_and_another_does_not() -> None:
    nodes = dict.fromkeys(("a @pc", "b @pc", "c @one"), "period: 10 ms, wcet: 3 ms")
    analysis = analyse_sketch(nodes, "", "hosts: {pc: {cores: 4}, one: {cores: 1}}")
    reasons = {name: (response.tier, response.reasons[0].text) for name, response in analysis.responses.items()}
    own_core = "its own work: pc has no more threads than cores"
    assert reasons == {
        "a": ("cores", own_core),
        "b": ("cores", own_core),
        "c": ("host", "the longest time for which all work on one can keep it busy, in whatever order"),
    }


@pytest.mark.parametrize(
    ("first", "second", "response"),
    [
        # 3 + 2 + 2 of `a` end at 7, just as `a` comes again.
        ("3 ms", "2 ms", "7"),
        # What takes no time itself waits on there: 5 + 2 and again 2.
        ("5 ms", "0 ms", "9"),
    ],
)
def test_what_takes_no_time_waits_for_what_comes_as_all_else_ends(first: str, second: str, response: str) -> None:
    nodes = {
        "a @pc": "period: 7 ms, wcet: 2 ms, priority: 9",
        "s +box": f"period: 40 ms, wcet: {first}, priority: 5",
        "t +box": f"period: 40 ms, wcet: {second}, priority: 5",
    }
    analysis = analyse_sketch(nodes, "", "hosts: {pc: {cores: 1}}\ncontainers: {box: {threads: 1, host: pc}}")
    assert show_ms(analysis.responses["t"].worst) == response
