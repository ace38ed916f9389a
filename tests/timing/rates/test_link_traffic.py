"""Links: what passes, what waits, and what is delayed by it."""

from __future__ import annotations

from fractions import Fraction

import pytest

from archgen.timing.analysis import LinkLoad
from archgen.timing.load.event_streams import EventStream
from archgen.timing.rates import link_traffic
from archgen.timing.run_analysis import analyse_architecture
from tests.timing.printed import show, show_ms
from tests.timing.random_systems import architecture
from tests.timing.sketches import (
    analyse_sketch,
    list_edges,
    list_links,
    list_outputs,
    list_paces,
    list_responses,
    list_services,
    list_topics,
)


def test_what_a_link_of_known_bandwidth_carries() -> None:
    """1 MB/s, so 1 ms for 1 kB and 0.5 ms for 500 B. Each 10, 7 and 30 ms 1 kB there, and two calls each 50 ms, with their answers."""
    analysis = analyse_sketch(
        {
            "a @one": "period: 10 ms, wcet: 1 ms, bcet: 1 ms",
            "b @two": "wcet: 1 ms, bcet: 1 ms",
            "c @two": "period: 30 ms, wcet: 1 ms, bcet: 1 ms",
            "h @one": "period: 7 ms, wcet: 0 ms, bcet: 0 ms",
            "d @three": "wcet: 2 ms, bcet: 1 ms",
            "s @two": "wcet: 1 ms, bcet: 1 ms",
            "t @one": "period: 50 ms, wcet: 1 ms, bcet: 1 ms, calls: {s: 2}",
            "o @one": "behaviour: once, wcet: 1 ms",
        },
        "a>b h>c a>c b>d t?s o>d",
        "hosts: {one: {cores: 4}, two: {cores: 4}, three: {cores: 4}}\n"
        "links: {lan: {connects: [one, two], bandwidth: 8 Mbit/s}, wan: {connects: [two, three], bandwidth: 16 Mbit/s, latency: {best: 1 ms, worst: 3 ms}}, via: {connects: [one, three], bandwidth: 16 Mbit/s, latency: {worst: 5 ms}}, spare: {connects: [one, three], bandwidth: 1 Mbit/s}}",
    )
    assert list_paces(analysis) == [
        "a periodic written: 100 Hz, gap 10, jitter 0, apart 10",
        "b event inferred: 100 Hz, gap 15, jitter 5, apart 5",
        "c periodic written: 100/3 Hz, gap 30, jitter 0, apart 30",
        "h periodic written: 1000/7 Hz, gap 7, jitter 0, apart 7",
        "d event inferred: 100 Hz, gap 17, jitter 7, apart 3",
        "s on_demand inferred: 40 Hz, gap none ?s, jitter 56, apart 0",
        "t periodic written: 20 Hz, gap 50, jitter 0, apart 50",
        "o once inferred: 0 Hz, gap none [unbounded], jitter 0, apart none [unbounded]",
    ]
    assert list_responses(analysis) == [
        "a 1..1 cores",
        "b 1..1 cores",
        "c 1..1 cores",
        "h 0..0 cores",
        "d 1..2 cores",
        "s 1..2 cores",
        "t 1..1 cores",
        "o none ?o..1 cores",
    ]
    assert list_links(analysis) == [
        "lan: 2680000/7 B/s, share 67/175, burst 5000 B, queueing 5; /g/a/out 200000, /g/h/out 1000000/7, /g/s/serve 40000",
        "wan: 100000 B/s, share 1/20, burst 1000 B, queueing 1/2; /g/b/out 100000",
        "via: 0 B/s, share 0, burst 0 B, queueing 0; /g/o/out 0",
        "spare: 0 B/s, share 0, burst 0 B, queueing 0; ",
    ]
    assert list_topics(analysis) == [
        "/g/a/out: 1000 B, 100000 B/s published, 200000 delivered",
        "/g/b/out: 1000 B, 100000 B/s published, 100000 delivered",
        "/g/c/out: 1000 B, 100000/3 B/s published, 0 delivered",
        "/g/h/out: 1000 B, 1000000/7 B/s published, 1000000/7 delivered",
        "/g/d/out: 1000 B, 100000 B/s published, 0 delivered",
        "/g/o/out: 1000 B, 0 B/s published, 0 delivered",
        "/g/t/out: 1000 B, 20000 B/s published, 0 delivered",
    ]
    assert list_edges(analysis) == [
        "a>b: loss 0, rereads 1, beat 0, queue 1",
        "a>c: loss 2/3, rereads 1, beat 0, queue 4",
        "b>d: loss 0, rereads 1, beat 0, queue 1",
        "h>c: loss 23/30, rereads 1, beat 105, queue 6",
        "o>d: loss 0, rereads 1, beat 0, queue 1",
    ]
    assert list_services(analysis) == [
        "s asked by t: 2; t waits 24 takes 25",
    ]


def test_two_clients_of_one_server() -> None:
    """Each client has its own answers: 3 each 50 ms for t, one each 20 ms for u, 500 B both ways: 2 x (60 + 50) x 500 B/s. All ten
    with those of `p` may wait at once: 5 kB; one more comes until they are sent: 5.5 ms.
    """
    analysis = analyse_sketch(
        {
            "t @one": "period: 50 ms, wcet: 1 ms, bcet: 1 ms, calls: {s: 3}",
            "u @one": "period: 20 ms, wcet: 2 ms, bcet: 1 ms",
            "s @two": "wcet: 1 ms, bcet: 1 ms",
            "p @two": "period: 30 ms, wcet: 1 ms, bcet: 1 ms",
            "v @one": "period: 40 ms, wcet: 1 ms, bcet: 1 ms",
            "q @four": "behaviour: periodic, wcet: 1 ms",
            "w @three": "period: 40 ms, wcet: 1 ms, bcet: 1 ms",
        },
        "t?s u?s v?p w?q",
        "hosts: {one: {cores: 8}, two: {cores: 8}, three: {cores: 8}, four: {cores: 8}}\n"
        "links: {lan: {connects: [one, two], bandwidth: 8 Mbit/s}, wan: {connects: [four, three], bandwidth: 8 Mbit/s}}",
    )
    assert list_paces(analysis) == [
        "t periodic written: 20 Hz, gap 50, jitter 0, apart 50",
        "u periodic written: 50 Hz, gap 20, jitter 0, apart 20",
        "s on_demand inferred: 110 Hz, gap none ?s, jitter 173273/4000, apart 0",
        "p periodic written: 100/3 Hz, gap 30, jitter 0, apart 30",
        "v periodic written: 25 Hz, gap 40, jitter 0, apart 40",
        "q periodic inferred: none ?q Hz, gap none ?q, jitter none ?q, apart none ?q",
        "w periodic written: 25 Hz, gap 40, jitter 0, apart 40",
    ]
    assert list_outputs(analysis) == [
        "t g.t.out periodic written: 20 Hz, gap 50, jitter 0, apart 50",
        "u g.u.out periodic written: 50 Hz, gap 21, jitter 1, apart 19",
        "s g.s.serve on_demand inferred: 110 Hz, gap none ?s, jitter 185273/4000, apart 0",
        "p g.p.serve periodic written: none ?p Hz, gap none ?p, jitter 0, apart 30",
        "v g.v.out periodic written: 25 Hz, gap 40, jitter 0, apart 40",
        "q g.q.serve periodic inferred: none ?q Hz, gap none ?q, jitter >= none ?q, apart none ?",
        "w g.w.out periodic written: 25 Hz, gap 40, jitter 0, apart 40",
    ]
    assert list_responses(analysis) == [
        "t 1..1 cores",
        "u 1..2 cores",
        "s 1..4 cores",
        "p 1..1 cores",
        "v 1..1 cores",
        "q none ?q..>= 1 ?q cores",
        "w 1..1 cores",
    ]
    assert list_links(analysis) == [
        "lan: 135000 B/s, share 27/200, burst 5000 B, queueing 11/2; /g/s/serve 110000, /g/p/serve 25000",
        "wan: 25000 B/s, share 1/40, burst >= 500 ?q B, queueing none ?q; /g/q/serve 25000",
    ]
    assert list_services(analysis) == [
        "s asked by t,u: 4; t waits 45 takes 46, u waits 15 takes 17",
        "p asked by v: 31; v waits 42 takes 43",
        "q asked by w: >= 1 ?q; w waits >= 1 ?q,wan takes >= 2 ?q,wan",
    ]


def test_what_is_not_known_of_a_link() -> None:
    """No bandwidth, no size, no rate, or more than the link carries. Each host has a core for each of its threads."""
    analysis = analyse_sketch(
        {
            "a @one": "period: 10 ms, wcet: 1 ms, bcet: 1 ms",
            "b @two": "wcet: 1 ms",
            "e @three": "",
            "f @one": "wcet: 1 ms",
            "g": "period: 20 ms, wcet: 1 ms",
            "h @two": "period: 1 ms, wcet: 0 ms, bcet: 0 ms",
            "i @three": "wcet: 0 ms, bcet: 0 ms",
            "j @four": "period: 20 ms, wcet: 1 ms, bcet: 1 ms",
            "k @one": "wcet: 1 ms",
            "l @four": "period: 10 ms, wcet: 11 ms",
            "m @one": "wcet: 1 ms",
            "n1 @four": "period: 10 ms, wcet: 0 ms, jitter: 4 ms",
        },
        "a>b e>f g>b h>i j>k l>m n1>m",
        "hosts: {one: {cores: 4}, two: {cores: 4}, three: {cores: 4}, four: {cores: 4}}\n"
        "links: {lan: {connects: [one, two], bandwidth: 8 Mbit/s}, wan: {connects: [two, three], bandwidth: 8 Mbit/s}, dark: {connects: [three, one], latency: 1 ms}, slow: {connects: [four, one], bandwidth: 16 Mbit/s}}",
    )
    assert list_paces(analysis) == [
        "a periodic written: 100 Hz, gap 10, jitter 0, apart 10",
        "b event inferred: 150 Hz, gap 11, jitter none ?g,b [no link joins their hosts], apart none ?g,b [no link joins their hosts]",
        "e None inferred: none ?e Hz, gap none ?e, jitter none ?e, apart none ?e",
        "f event inferred: none ?e Hz, gap none ?e, jitter none ?e, apart none ?e",
        "g periodic written: 50 Hz, gap 20, jitter 0, apart 20",
        "h periodic written: 1000 Hz, gap 1, jitter 0, apart 1",
        "i event inferred: 1000 Hz, gap >= 1 ?wan, jitter none ?wan, apart none ?wan",
        "j periodic written: 50 Hz, gap 20, jitter 0, apart 20",
        "k event inferred: 50 Hz, gap >= 20 ?slow, jitter none ?slow, apart none ?slow",
        "l periodic written: 100 Hz, gap 10, jitter 0, apart 10",
        "m event inferred: 200 Hz, gap >= 14 ?slow, jitter none ?slow [unbounded], apart none ?slow [unbounded]",
        "n1 periodic written: 100 Hz, gap 14, jitter 4, apart 6",
    ]
    assert list_outputs(analysis) == [
        "a g.a.out periodic written: 100 Hz, gap 10, jitter 0, apart 10",
        "b g.b.out event inferred: 150 Hz, gap >= 11 ?g,b [no link joins their hosts], jitter >= none ?g,b [no link joins their hosts], apart none ?",
        "e g.e.out None inferred: none ?e Hz, gap none ?e, jitter >= none ?e, apart none ?",
        "f g.f.out event inferred: none ?e Hz, gap none ?e, jitter >= none ?e, apart none ?",
        "g g.g.out periodic written: 50 Hz, gap 21, jitter 1, apart 19",
        "h g.h.out periodic written: 1000 Hz, gap 1, jitter 0, apart 1",
        "i g.i.out event inferred: 1000 Hz, gap >= 1 ?wan, jitter none ?wan, apart none ?wan",
        "j g.j.out periodic written: 50 Hz, gap 20, jitter 0, apart 20",
        "k g.k.out event inferred: 50 Hz, gap >= 20 ?slow, jitter >= none ?slow, apart none ?",
        "l g.l.out periodic written: 100 Hz, gap none [overload], jitter none [overload], apart 0",
        "m g.m.out event inferred: 200 Hz, gap none ?slow [unbounded], jitter none ?slow [unbounded], apart none ?",
        "n1 g.n1.out periodic written: 100 Hz, gap 14, jitter 4, apart 6",
    ]
    assert list_responses(analysis) == [
        "a 1..1 cores",
        "b none ?b..>= 1 ?g,b [no link joins their hosts] cores",
        "e none ?e..>= none ?e unknown",
        "f none ?f..>= 1 ?e cores",
        "g none ?g..1 [assuming a dedicated core] dedicated",
        "h 0..0 cores",
        "i 0..0 cores",
        "j 1..1 cores",
        "k none ?k..>= 1 ?slow cores",
        "l none ?l..none [overload] cores",
        "m none ?m..none ?slow [unbounded] cores",
        "n1 none ?n1..0 cores",
    ]
    assert list_links(analysis) == [
        "lan: 100000 B/s, share 1/10, burst 1000 B, queueing 1; /g/a/out 100000",
        "wan: 1000000 B/s, share 1, burst none [unbounded] B, queueing none [unbounded]; /g/h/out 1000000",
        "dark: none ?e B/s, share none ?dark, burst >= 0 ?e B, queueing none ?dark; /g/e/out none ?e",
        "slow: 250000 B/s, share 1/8, burst >= 2000 ?l B, queueing none ?l [unbounded]; /g/j/out 50000, /g/l/out 100000, /g/n1/out 100000",
    ]
    assert list_topics(analysis) == [
        "/g/a/out: 1000 B, 100000 B/s published, 100000 delivered",
        "/g/b/out: 1000 B, 150000 B/s published, 0 delivered",
        "/g/g/out: 1000 B, 50000 B/s published, 50000 delivered",
        "/g/e/out: 1000 B, none ?e B/s published, none ?e delivered",
        "/g/f/out: 1000 B, none ?e B/s published, 0 delivered",
        "/g/h/out: 1000 B, 1000000 B/s published, 1000000 delivered",
        "/g/i/out: 1000 B, 1000000 B/s published, 0 delivered",
        "/g/j/out: 1000 B, 50000 B/s published, 50000 delivered",
        "/g/k/out: 1000 B, 50000 B/s published, 0 delivered",
        "/g/l/out: 1000 B, 100000 B/s published, 100000 delivered",
        "/g/m/out: 1000 B, 200000 B/s published, 0 delivered",
        "/g/n1/out: 1000 B, 100000 B/s published, 100000 delivered",
    ]
    assert list_edges(analysis) == [
        "a>b: loss 0, rereads 1, beat 0, queue none ?g,b [no link joins their hosts]",
        "g>b: loss 0, rereads 1, beat 0, queue none ?g,b [no link joins their hosts]",
        "e>f: loss 0, rereads 1, beat 0, queue none ?e",
        "h>i: loss 0, rereads 1, beat 0, queue none ?wan",
        "j>k: loss 0, rereads 1, beat 0, queue none ?slow",
        "l>m: loss 0, rereads 1, beat 0, queue none [unbounded]",
        "n1>m: loss 0, rereads 1, beat 0, queue none ?slow",
    ]


@pytest.mark.parametrize(
    ("jitter", "burst", "queueing"),
    [
        # 1 kB each 10 ms takes 2 ms. The next one may come with the first, or while it is sent: half of it is gone after 1 ms.
        ("0 ms", "1000", "2"),
        ("8 ms", "1000", "2"),
        ("9 ms", "1500", "4"),
        ("10 ms", "2000", "4"),
        ("20 ms", "3000", "6"),
        ("30 ms", "4000", "8"),
        # Two at once, and the third half way through the first of them: 2000 - 500 + 1000.
        ("19 ms", "2500", "6"),
    ],
)
def test_what_can_wait_before_a_link(jitter: str, burst: str, queueing: str) -> None:
    load = _load_of_link(jitter)
    assert (show(load.burst), show_ms(load.queueing)) == (burst, queueing)


def _load_of_link(jitter: str) -> LinkLoad:
    nodes = {"a @p": f"period: 10 ms, jitter: {jitter}, wcet: 0 ms, bcet: 0 ms", "b @q": "period: 5 ms"}
    rest = "hosts: {p: {}, q: {}}\nlinks: {lan: {connects: [p, q], bandwidth: 4 Mbit/s, latency: 50 ms}}"
    return analyse_sketch(nodes, "a>b", rest).links["lan"]


@pytest.mark.parametrize(("limit", "burst"), [(3, "3000"), (2, "none [diverged]")])
def test_only_so_many_arrivals_are_followed(monkeypatch: pytest.MonkeyPatch, limit: int, burst: str) -> None:
    """One at the start and two that may come at once; the next one finds nothing waiting."""
    monkeypatch.setattr(link_traffic, "_MAX_ARRIVALS", limit)
    assert show(_load_of_link("20 ms").burst) == burst


@pytest.mark.parametrize(
    ("timing", "size", "published"),
    [
        ("period: 1 s", ", size: 1 kB", "1000"),
        ("period: 1 s", "", "none ?/g/a/out"),
        # What is never sent any more is no traffic, of whatever size.
        ("behaviour: once", ", size: 1 kB", "0"),
        ("behaviour: once", "", "0"),
        ("wcet: 1 ms", ", size: 1 kB", "none ?a"),
    ],
)
def test_traffic_is_rate_times_size(timing: str, size: str, published: str) -> None:
    text = f"""
groups: {{g: {{components: {{a: {{outputs: {{out: Data}}}}}}}}}}
nodes: {{a: {{implements: a, timing: {{{timing}}}}}}}
types: {{Data: {{message: std_msgs/msg/String{size}}}}}
"""
    assert show(analyse_architecture(architecture(text)).topics["/g/a/out"].published) == published


def test_the_first_of_two_equally_large_backlogs_is_told() -> None:
    """15 B at the start; 5 of them are sent by 5, when the late message brings 5 more."""
    sized_models = [(10, (EventStream(100),)), (5, (EventStream(100, 95),))]
    backlog = link_traffic.find_largest_backlog(sized_models, Fraction(1))
    assert (backlog.size.value, backlog[1]) == (15, 0)
    assert link_traffic.find_largest_backlog([*sized_models, (1, (EventStream(100, 95),))], Fraction(1))[1] == 5
