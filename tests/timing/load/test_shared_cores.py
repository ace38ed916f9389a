"""Several cores, containers and pins: whose work stands in whose way."""

from __future__ import annotations

import pytest

from tests.timing.printed import show_ms
from tests.timing.sketches import analyse_sketch, list_hosts, list_reasons, list_responses


def test_cores_containers_and_pins() -> None:
    """`a` alone beside no more threads than cores waits for nobody; a container's threads divide its own work; where every core has
    a pin, what has none may run anywhere.

    c: 3 + (4 + 5) / 2; d: 4 + (3 + 5) / 2; e: 5 + (3 + 4) / 2; f: 6, for the third core is left to it. i: 2 + (3 + 4) / 2; j: 3 + (2 x 2 + 4) / 2; k: 4 + (2 x 2 + 3) / 2.
    n: 4 + 2: one of its two cores alone would let it wait for `l` only.
    """
    analysis = analyse_sketch(
        {
            "a @two": "period: 10 ms, wcet: 4 ms",
            "b @two": "period: 10 ms, wcet: 9 ms",
            "c +pool": "period: 20 ms, wcet: 3 ms",
            "d +pool": "period: 20 ms, wcet: 4 ms",
            "e +pool": "period: 40 ms, wcet: 5 ms",
            "f @four": "period: 40 ms, wcet: 6 ms",
            "g +lone": "period: 10 ms, wcet: 2 ms",
            "h +lone": "period: 20 ms, wcet: 3 ms",
            "i +duo": "period: 10 ms, wcet: 2 ms",
            "j +duo": "period: 20 ms, wcet: 3 ms",
            "k +duo": "period: 30 ms, wcet: 4 ms",
            "l @pins": "period: 10 ms, wcet: 2 ms, core: 0",
            "m @pins": "period: 10 ms, wcet: 3 ms, core: 1",
            "n @pins": "period: 20 ms, wcet: 4 ms",
            "o +torn": "period: 10 ms, wcet: 1 ms, core: 0",
            "p +torn": "period: 20 ms, wcet: 2 ms, core: 1",
            "q +torn": "period: 40 ms, wcet: 3 ms",
            "r +split": "period: 10 ms, wcet: 1 ms, core: 0",
            "s +split": "period: 20 ms, wcet: 2 ms, core: 1",
            "t +split": "period: 40 ms, wcet: 3 ms, core: 1",
            "u @gap": "period: 10 ms, wcet: 2 ms, core: 7",
            "v +exec": "period: 10 ms, wcet: 2 ms",
            "w +exec": "period: 20 ms, wcet: 3 ms",
        },
        "",
        "hosts: {two: {cores: 2}, four: {cores: 3}, pins: {cores: 2}, rip: {cores: 3}, rift: {cores: 3}, gap: {cores: 2}, ex: {cores: 2}}\n"
        "containers: {pool: {threads: 2, host: four}, lone: {threads: 1}, duo: {threads: 2}, torn: {threads: 1, host: rip}, split: {threads: 2, host: rift}, exec: {threads: 1, host: ex}}",
    )
    assert list_responses(analysis) == [
        "a none ?a..4 cores",
        "b none ?b..9 cores",
        "c none ?c..15/2 cores",
        "d none ?d..8 cores",
        "e none ?e..17/2 cores",
        "f none ?f..6 cores",
        "g none ?g..5 [assuming a dedicated core for container lone] executor",
        "h none ?h..5 [assuming a dedicated core for container lone] executor",
        "i none ?i..11/2 [assuming 2 dedicated cores for container duo] cores",
        "j none ?j..7 [assuming 2 dedicated cores for container duo] cores",
        "k none ?k..15/2 [assuming 2 dedicated cores for container duo] cores",
        "l none ?l..6 host",
        "m none ?m..7 host",
        "n none ?n..6 cores",
        "o none ?o..6 [container torn has one thread: it runs where the first pinned member is] executor",
        "p none ?p..6 [container torn has one thread: it runs where the first pinned member is] executor",
        "q none ?q..6 [container torn has one thread: it runs where the first pinned member is] executor",
        "r none ?r..6 host",
        "s none ?s..6 host",
        "t none ?t..6 host",
        "u none ?u..2 cores",
        "v none ?v..5 executor",
        "w none ?w..5 executor",
    ]
    assert list_reasons(analysis) == [
        "a: every 10 ms, as written @28:50",
        "b: every 10 ms, as written @29:50",
        "c: every 20 ms, as written @30:56",
        "d: every 20 ms, as written @31:56",
        "e: every 40 ms, as written @32:56",
        "f: every 40 ms, as written @33:51",
        "g: every 10 ms, as written @34:56",
        "h: every 20 ms, as written @35:56",
        "i: every 10 ms, as written @36:55",
        "j: every 20 ms, as written @37:55",
        "k: every 30 ms, as written @38:55",
        "l: every 10 ms, as written @39:51",
        "m: every 10 ms, as written @40:51",
        "n: every 20 ms, as written @41:51",
        "o: every 10 ms, as written @42:56",
        "p: every 20 ms, as written @43:56",
        "q: every 40 ms, as written @44:56",
        "r: every 10 ms, as written @45:57",
        "s: every 20 ms, as written @46:57",
        "t: every 40 ms, as written @47:57",
        "u: every 10 ms, as written @48:50",
        "v: every 10 ms, as written @49:56",
        "w: every 20 ms, as written @50:56",
        "a takes: its own work: two has no more threads than cores @28:63",
        "b takes: its own work: two has no more threads than cores @29:63",
        "c takes: all work of its own thread, and a share of all other work on the 2 cores of four @30:69",
        "d takes: all work of its own thread, and a share of all other work on the 2 cores of four @31:69",
        "e takes: all work of its own thread, and a share of all other work on the 2 cores of four @32:69",
        "f takes: its own work: four has no more threads than cores @33:64",
        "g takes: all work of its executor on lone, in whatever order @34:69",
        "h takes: all work of its executor on lone, in whatever order @35:69",
        "i takes: all work of its own thread, and a share of all other work on the 2 cores of duo @36:68",
        "j takes: all work of its own thread, and a share of all other work on the 2 cores of duo @37:68",
        "k takes: all work of its own thread, and a share of all other work on the 2 cores of duo @38:68",
        "l takes: the longest time for which all work on pins core 0 can keep it busy, in whatever order @39:64",
        "m takes: the longest time for which all work on pins core 1 can keep it busy, in whatever order @40:64",
        "n takes: all work of its own thread, and a share of all other work on the 2 cores of pins @41:64",
        "o takes: all work of its executor on rip core 0, in whatever order @42:69",
        "p takes: all work of its executor on rip core 0, in whatever order @43:69",
        "q takes: all work of its executor on rip core 0, in whatever order @44:69",
        "r takes: the longest time for which all work on rift core 0 and on those that wait with it for a container's threads (one of them works while any waits) can keep it busy, in whatever order @45:70",
        "s takes: the longest time for which all work on rift core 1 and on those that wait with it for a container's threads (one of them works while any waits) can keep it busy, in whatever order @46:70",
        "t takes: the longest time for which all work on rift core 1 and on those that wait with it for a container's threads (one of them works while any waits) can keep it busy, in whatever order @47:70",
        "u takes: its own work: gap has no more threads than cores @48:63",
        "v takes: all work of its executor on ex, in whatever order @49:69",
        "w takes: all work of its executor on ex, in whatever order @50:69",
    ]
    assert list_hosts(analysis) == [
        "two: 13/10 of 2: schedulable; rm none [one core only], edf none [one core only]",
        "  two (2) 13/10",
        "  a 2/5, b 9/10",
        "four: 5/8 of 3: schedulable; rm none [one core only], edf none [one core only]",
        "  four (3) 5/8",
        "  c 3/20, d 1/5, e 1/8, f 3/20",
        "pins: 7/10 of 2: schedulable; rm none [one core only], edf none [one core only]",
        "  pins core 0 (1) 1/5, pins core 1 (1) 3/10, pins (2) 1/5",
        "  l 1/5, m 3/10, n 1/5",
        "rip: 11/40 of 3: schedulable; rm none [one core only], edf none [one core only]",
        "  rip core 0 (1) 11/40",
        "  o 1/10, p 1/10, q 3/40",
        "rift: 11/40 of 3: schedulable; rm none [one core only], edf none [one core only]",
        "  rift core 0 (1) 1/10, rift core 1 (1) 7/40",
        "  r 1/10, s 1/10, t 3/40",
        "gap: 1/5 of 2: schedulable; rm none [one core only], edf none [one core only]",
        "  gap (2) 1/5",
        "  u 1/5",
        "ex: 7/20 of 2: schedulable; rm none [one core only], edf none [one core only]",
        "  ex (2) 7/20",
        "  v 1/5, w 3/20",
    ]


def test_full_and_open_cores() -> None:
    """Two cores are full at 2; a thread of 1 is too much for itself, and for all beside it; what nobody wrote leaves all
    beside it open.

    p: two at once, 2 x 3 + B, where 2 B = min(4 x 4, B) + 2 x 5; q: 2 x 4 + B, where 2 B = min(5 x 3, B) + 2 x 5; r: 5 + (4 x 3 + 3 x 4 + 4) / 2,
    as one thread was busy before.
    """
    analysis = analyse_sketch(
        {
            "a @full": "period: 10 ms, wcet: 10 ms",
            "b @full": "period: 10 ms, wcet: 5 ms",
            "c @full": "period: 10 ms, wcet: 5 ms",
            "d @one": "period: 10 ms, wcet: 10 ms",
            "e @one": "period: 10 ms, wcet: 1 ms",
            "f @one": "period: 10 ms, wcet: 2 ms",
            "g @open": "period: 10 ms",
            "h @open": "period: 10 ms, wcet: 2 ms",
            "i @open": "period: 10 ms, wcet: 2 ms",
            "j @late": "period: 10 ms, wcet: 9 ms",
            "k @late": "period: 10 ms, wcet: 2 ms",
            "l @late": "period: 10 ms, wcet: 2 ms",
            "m @over": "period: 10 ms, wcet: 8 ms",
            "n @over": "period: 10 ms, wcet: 8 ms",
            "o @over": "period: 10 ms, wcet: 8 ms",
            "p @spare": "period: 10 ms, jitter: 12 ms, wcet: 3 ms",
            "q @spare": "period: 15 ms, jitter: 20 ms, wcet: 4 ms",
            "r @spare": "period: 20 ms, wcet: 5 ms",
        },
        "",
        "hosts: {full: {cores: 2}, one: {cores: 2}, open: {cores: 2}, late: {cores: 2}, over: {cores: 2}, spare: {cores: 2}}",
    )
    assert list_responses(analysis) == [
        "a none ?a..none [overload] cores",
        "b none ?b..none [overload] cores",
        "c none ?c..none [overload] cores",
        "d none ?d..none [overload] cores",
        "e none ?e..none [diverged] cores",
        "f none ?f..none [diverged] cores",
        "g none ?g..>= none ?g unknown",
        "h none ?h..>= 2 ?g cores",
        "i none ?i..>= 2 ?g cores",
        "j none ?j..none [diverged] cores",
        "k none ?k..none [diverged] cores",
        "l none ?l..none [diverged] cores",
        "m none ?m..none [overload] cores",
        "n none ?n..none [overload] cores",
        "o none ?o..none [overload] cores",
        "p none ?p..16 cores",
        "q none ?q..18 cores",
        "r none ?r..19 cores",
    ]
    assert list_hosts(analysis) == [
        "full: 2 of 2: overload; rm none [one core only], edf none [one core only]",
        "  full (2) 2",
        "  a 1, b 1/2, c 1/2",
        "one: 13/10 of 2: undecided; rm none [one core only], edf none [one core only]",
        "  one (2) 13/10",
        "  d 1, e 1/10, f 1/5",
        "open: >= 2/5 ?g of 2: unknown; rm none [one core only], edf none [one core only]",
        "  open (2) >= 2/5 ?g",
        "  g none ?g, h 1/5, i 1/5",
        "late: 13/10 of 2: undecided; rm none [one core only], edf none [one core only]",
        "  late (2) 13/10",
        "  j 9/10, k 1/5, l 1/5",
        "over: 12/5 of 2: overload; rm none [one core only], edf none [one core only]",
        "  over (2) 12/5",
        "  m 4/5, n 4/5, o 4/5",
        "spare: 49/60 of 2: undecided; rm none [one core only], edf none [one core only]",
        "  spare (2) 49/60",
        "  p 3/10, q 4/15, r 1/4",
    ]


def test_priorities_in_crowded_containers() -> None:
    """Two threads for three members: who waits for one may wait for the least urgent member, and so do those beside it that are as
    urgent as some member.
    """
    analysis = analyse_sketch(
        {
            "a +pool": "period: 20 ms, wcet: 1 ms, priority: 9",
            "b +pool": "period: 20 ms, wcet: 2 ms, priority: 5",
            "c +pool": "period: 40 ms, wcet: 3 ms, priority: 1",
            "d @pc": "period: 40 ms, wcet: 4 ms, priority: 7",
            "e @pc": "period: 80 ms, wcet: 5 ms, priority: 3",
            "f @pc": "period: 80 ms, wcet: 6 ms, priority: 10",
            "g @pc": "period: 80 ms, wcet: 7 ms, priority: 0",
            "h @free": "period: 20 ms, wcet: 1 ms, priority: 3",
            "i @free": "period: 20 ms, wcet: 2 ms, priority: 3",
            "j @free": "period: 20 ms, wcet: 3 ms",
            "k +exec": "period: 20 ms, wcet: 1 ms, priority: 4",
            "l +exec": "period: 20 ms, wcet: 2 ms, priority: 2",
            "m @solo": "period: 40 ms, wcet: 3 ms, priority: 3",
            "n @solo": "period: 40 ms, wcet: 4 ms, priority: 1",
            "o @solo": "behaviour: once, wcet: 50 ms",
            "p +roomy": "period: 20 ms, wcet: 1 ms, priority: 9",
            "q +roomy": "period: 20 ms, wcet: 2 ms, priority: 1",
            "r @hall": "period: 20 ms, wcet: 4 ms, priority: 5",
            "s +half": "period: 20 ms, wcet: 1 ms, priority: 9",
            "t +half": "period: 20 ms, wcet: 2 ms",
            "u +half": "period: 20 ms, wcet: 2 ms, priority: 4",
            "v @den": "period: 20 ms, wcet: 4 ms, priority: 5",
            "w @den": "period: 20 ms, wcet: 1 ms, priority: 12",
        },
        "",
        "hosts: {pc: {cores: 1}, free: {cores: 1}, solo: {cores: 1}, hall: {cores: 1}, den: {cores: 1}}\n"
        "containers: {pool: {threads: 2, host: pc}, exec: {threads: 1, host: solo}, roomy: {threads: 2, host: hall}, half: {threads: 2, host: den}}",
    )
    assert list_responses(analysis) == [
        "a none ?a..23 priorities",
        "b none ?b..22 priorities",
        "c none ?c..24 priorities",
        "d none ?d..24 priorities",
        "e none ?e..24 priorities",
        "f none ?f..6 priorities",
        "g none ?g..31 priorities",
        "h none ?h..3 priorities",
        "i none ?i..3 priorities",
        "j none ?j..6 host",
        "k none ?k..6 executor",
        "l none ?l..6 executor",
        "m none ?m..6 priorities",
        "n none ?n..10 priorities",
        "o none ?o..76 host",
        "p none ?p..1 priorities",
        "q none ?q..7 priorities",
        "r none ?r..5 priorities",
        "s none ?s..10 host",
        "t none ?t..10 host",
        "u none ?u..10 host",
        "v none ?v..10 host",
        "w none ?w..1 priorities",
    ]


def test_priorities_and_what_is_missing() -> None:
    """Only what is as urgent or more can stand in the way: `a` has a bound though `b` has none, and `d` none for `b`."""
    analysis = analyse_sketch(
        {
            "a @pc": "period: 20 ms, wcet: 1 ms, priority: 9",
            "b @pc": "period: 20 ms, priority: 5",
            "c @pc": "period: 20 ms, wcet: 2 ms, priority: 7",
            "d @pc": "period: 20 ms, wcet: 3 ms, priority: 3",
            "e @pc": "period: 20 ms, wcet: 4 ms",
            "f @hot": "period: 10 ms, wcet: 6 ms, priority: 3",
            "g @hot": "period: 10 ms, wcet: 4 ms, priority: 2",
            "h @hot": "period: 10 ms, wcet: 1 ms, priority: 1",
            "i @jit": "period: 10 ms, jitter: 1 ms, wcet: 6 ms, priority: 3",
            "j @jit": "period: 10 ms, wcet: 4 ms, priority: 2",
            "k @brim": "period: 10 ms, wcet: 5 ms, priority: 3",
            "l @brim": "period: 40 ms, wcet: 20 ms, priority: 2",
            "m @idle": "behaviour: once, priority: 8",
            "n @idle": "period: 10 ms, wcet: 2 ms, priority: 3",
            "o @idle": "behaviour: once, wcet: 5 ms",
            "p @idle": "period: 10 ms, wcet: 1 ms",
        },
        "",
        "hosts: {pc: {cores: 1}, hot: {cores: 1}, jit: {cores: 1}, brim: {cores: 1}, idle: {cores: 1}}",
    )
    assert list_responses(analysis) == [
        "a none ?a..1 priorities",
        "b none ?b..>= none ?b unknown",
        "c none ?c..3 priorities",
        "d none ?d..>= 3 ?b priorities",
        "e none ?e..>= 4 ?b host",
        "f none ?f..6 priorities",
        "g none ?g..10 priorities",
        "h none ?h..none [overload] priorities",
        "i none ?i..6 priorities",
        "j none ?j..none [overload] priorities",
        "k none ?k..5 priorities",
        "l none ?l..40 priorities",
        "m none ?m..>= none ?m unknown",
        "n none ?n..2 priorities",
        "o none ?o..8 host",
        "p none ?p..3 host",
    ]
    assert list_hosts(analysis) == [
        "pc: >= 1/2 ?b of 1: unknown; rm 74349177/100000000, edf 1",
        "  pc (1) >= 1/2 ?b",
        "  a 1/20, b none ?b, c 1/10, d 3/20, e 1/5",
        "hot: 11/10 of 1: overload; rm 779763147/1000000000, edf 1",
        "  hot (1) 11/10",
        "  f 3/5, g 2/5, h 1/10",
        "jit: 1 of 1: overload; rm 207106781/250000000, edf 1",
        "  jit (1) 1",
        "  i 3/5, j 2/5",
        "brim: 1 of 1: schedulable; rm 207106781/250000000, edf 1",
        "  brim (1) 1",
        "  k 1/2, l 1/2",
        "idle: 3/10 of 1: schedulable; rm 207106781/250000000, edf 1",
        "  idle (1) 3/10",
        "  m 0, n 1/5, o 0, p 1/10",
    ]


@pytest.mark.parametrize(
    ("priority", "response"),
    [
        # More urgent than all of the pool: 4 alone.
        (8, "4"),
        # As urgent as `a`: it lets pass what piled up while the pool's threads were held, 1 + 2 + 3 + 4; and so down to `c`.
        (7, "10"),
        (6, "10"),
        (1, "10"),
        # Below: all of them in any case.
        (0, "10"),
    ],
)
def test_who_is_as_urgent_as_some_member_of_a_crowded_container_waits_for_its_least(
    priority: int, response: str
) -> None:
    nodes = {
        "a +pool": "period: 100 ms, wcet: 1 ms, priority: 7",
        "b +pool": "period: 100 ms, wcet: 2 ms, priority: 5",
        "c +pool": "period: 100 ms, wcet: 3 ms, priority: 1",
        "d @pc": f"period: 100 ms, wcet: 4 ms, priority: {priority}",
    }
    rest = "hosts: {pc: {cores: 1}}\ncontainers: {pool: {threads: 2, host: pc}}"
    assert show_ms(analyse_sketch(nodes, "", rest).responses["d"].worst) == response


@pytest.mark.parametrize(
    ("threads", "responses"),
    [
        (
            "executable: component_container_mt",
            ["1 [assuming a dedicated core] dedicated", "2 [assuming a dedicated core] dedicated"],
        ),
        ("threads: 2", ["1 [assuming a dedicated core] dedicated", "2 [assuming a dedicated core] dedicated"]),
        ("threads: 1", ["3 [assuming a dedicated core for container box] executor"] * 2),
        # What `component_container` has, which is started where nothing is written.
        ("", ["3 [assuming a dedicated core for container box] executor"] * 2),
    ],
)
def test_a_thread_for_each_member_needs_no_waiting(threads: str, responses: list[str]) -> None:
    nodes = {"a +box": "period: 10 ms, wcet: 1 ms", "b +box": "period: 10 ms, wcet: 2 ms"}
    analysis = analyse_sketch(nodes, "", f"containers: {{box: {{{threads}}}}}")
    assert [f"{show_ms(time.worst)} {time.tier}" for time in analysis.responses.values()] == responses


@pytest.mark.parametrize(
    ("threads", "responses"),
    [
        # With a thread for each member, priorities alone count: 1, 1 + 2, 1 + 2 + 3.
        ("executable: component_container_isolated", ["1", "3", "6"]),
        ("threads: 3", ["1", "3", "6"]),
        # With fewer, each may wait for one that the least urgent member holds.
        ("threads: 2", ["6", "6", "6"]),
        ("threads: 1", ["6", "6", "6"]),
        ("", ["6", "6", "6"]),
    ],
)
def test_members_wait_for_each_other_only_where_threads_are_fewer(threads: str, responses: list[str]) -> None:
    nodes = {
        "a +box": "period: 100 ms, wcet: 1 ms, priority: 3",
        "b +box": "period: 100 ms, wcet: 2 ms, priority: 2",
        "c +box": "period: 100 ms, wcet: 3 ms, priority: 1",
    }
    rest = f"hosts: {{pc: {{cores: 1}}}}\ncontainers: {{box: {{{threads and f'{threads}, '}host: pc}}}}"
    assert [show_ms(time.worst) for time in analyse_sketch(nodes, "", rest).responses.values()] == responses
