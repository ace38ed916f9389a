"""Event models from sources to sinks: across hosts, round loops, behind what has no bound."""

from __future__ import annotations

from archgen.timing.chains.chain_bounds import bound_all_chains
from tests.timing.printed import show_ms
from tests.timing.sketches import (
    analyse_sketch,
    list_edges,
    list_hosts,
    list_outputs,
    list_paces,
    list_responses,
    read_sketch,
)


def test_what_is_behind_an_overload() -> None:
    """A reader of what is overloaded is not overloaded itself: its input has no bound. What is behind a figure that nobody wrote names it."""
    analysis = analyse_sketch(
        {
            "hot @pc": "period: 10 ms, wcet: 12 ms",
            "next @far": "wcet: 1 ms",
            "last @far": "wcet: 1 ms",
            "beside @far": "period: 20 ms, wcet: 2 ms, priority: 3",
            "dark @pc2": "period: 10 ms",
            "after @far2": "wcet: 1 ms, priority: 2",
            "free @far2": "period: 10 ms, wcet: 2 ms, priority: 4",
            "low @far2": "period: 10 ms, wcet: 2 ms, priority: 1",
        },
        "hot>next next>last dark>after",
        "hosts: {pc: {cores: 1}, far: {cores: 1}, pc2: {cores: 1}, far2: {cores: 1}}\n"
        "links: {lan: {connects: [pc, far, pc2, far2], latency: {best: 1 ms, worst: 2 ms}}}",
    )
    assert list_paces(analysis) == [
        "hot periodic written: 100 Hz, gap 10, jitter 0, apart 10",
        "next event inferred: 100 Hz, gap none [overload], jitter none [unbounded], apart none [unbounded]",
        "last event inferred: 100 Hz, gap none [overload], jitter none [unbounded], apart none [unbounded]",
        "beside periodic written: 50 Hz, gap 20, jitter 0, apart 20",
        "dark periodic written: 100 Hz, gap 10, jitter 0, apart 10",
        "after event inferred: 100 Hz, gap >= 11 ?dark, jitter none ?dark, apart none ?dark",
        "free periodic written: 100 Hz, gap 10, jitter 0, apart 10",
        "low periodic written: 100 Hz, gap 10, jitter 0, apart 10",
    ]
    assert list_outputs(analysis) == [
        "hot g.hot.out periodic written: 100 Hz, gap none [overload], jitter none [overload], apart 0",
        "next g.next.out event inferred: 100 Hz, gap none [overload], jitter none [unbounded], apart none [unbounded]",
        "last g.last.out event inferred: 100 Hz, gap none [overload], jitter none [unbounded], apart none [unbounded]",
        "beside g.beside.out periodic written: 50 Hz, gap 22, jitter 2, apart 18",
        "dark g.dark.out periodic written: 100 Hz, gap >= 10 ?dark, jitter >= 0 ?dark, apart 0",
        "after g.after.out event inferred: 100 Hz, gap >= 11 ?dark, jitter >= none ?dark, apart none ?",
        "free g.free.out periodic written: 100 Hz, gap 12, jitter 2, apart 8",
        "low g.low.out periodic written: 100 Hz, gap >= 10 ?dark, jitter >= 0 ?dark, apart 0",
    ]
    assert list_responses(analysis) == [
        "hot none ?hot..none [overload] host",
        "next none ?next..none [unbounded] host",
        "last none ?last..none [unbounded] host",
        "beside none ?beside..2 priorities",
        "dark none ?dark..>= none ?dark unknown",
        "after none ?after..>= 1 ?dark priorities",
        "free none ?free..2 priorities",
        "low none ?low..>= 2 ?dark priorities",
    ]
    assert list_hosts(analysis) == [
        "pc: 6/5 of 1: overload; rm 1, edf 1",
        "  pc (1) 6/5",
        "  hot 6/5",
        "far: 3/10 of 1: undecided; rm 779763147/1000000000, edf 1",
        "  far (1) 3/10",
        "  next 1/10, last 1/10, beside 1/10",
        "pc2: none ?dark of 1: unknown; rm 1, edf 1",
        "  pc2 (1) none ?dark",
        "  dark none ?dark",
        "far2: 1/2 of 1: undecided; rm 779763147/1000000000, edf 1",
        "  far2 (1) 1/2",
        "  after 1/10, free 1/5, low 1/5",
    ]


def test_jitter_goes_round_two_hosts() -> None:
    """Each response is the next one's jitter. a: 2 + 3 (d), for the e of the event before ended long ago; b: comes (5 - 2) + 1
    late, on its host 4 + 2; and so on, until nothing changes.

    On r one core works for each of two threads at most. f: 1 + B with 2 B = min(7, B) + 3, so 4; g: 7 + 2, as two of f come within 9
    and 2 B = 2 + min(3, B); h: 3 + 1, as 2 B = 1 + min(7, B).
    """
    analysis = analyse_sketch(
        {
            "a @p": "period: 20 ms, wcet: 2 ms, bcet: 2 ms",
            "b @q": "wcet: 4 ms, bcet: 1 ms",
            "c @q": "period: 30 ms, wcet: 2 ms, bcet: 2 ms",
            "d @p": "wcet: 3 ms, bcet: 3 ms",
            "e @p": "wcet: 1 ms, bcet: 1 ms",
            "f @r": "wcet: 1 ms",
            "g @r": "period: 40 ms, wcet: 7 ms",
            "h @r": "wcet: 3 ms",
        },
        "a>b c>d b>e e>f d>h",
        "hosts: {p: {cores: 1}, q: {cores: 1}, r: {cores: 2}}\n"
        "links: {lan: {connects: [p, q, r], latency: {best: 0 ms, worst: 1 ms}}}",
    )
    assert list_paces(analysis) == [
        "a periodic written: 50 Hz, gap 20, jitter 0, apart 20",
        "b event inferred: 50 Hz, gap 24, jitter 4, apart 16",
        "c periodic written: 100/3 Hz, gap 30, jitter 0, apart 30",
        "d event inferred: 100/3 Hz, gap 35, jitter 5, apart 25",
        "e event inferred: 50 Hz, gap 30, jitter 10, apart 10",
        "f event inferred: 50 Hz, gap 36, jitter 11, apart 9",
        "g periodic written: 25 Hz, gap 40, jitter 0, apart 40",
        "h event inferred: 100/3 Hz, gap 39, jitter 9, apart 21",
    ]
    assert list_outputs(analysis) == [
        "a g.a.out periodic written: 50 Hz, gap 23, jitter 3, apart 17",
        "b g.b.out event inferred: 50 Hz, gap 29, jitter 9, apart 11",
        "c g.c.out periodic written: 100/3 Hz, gap 34, jitter 4, apart 26",
        "d g.d.out event inferred: 100/3 Hz, gap 38, jitter 8, apart 22",
        "e g.e.out event inferred: 50 Hz, gap 35, jitter 15, apart 5",
        "f g.f.out event inferred: 50 Hz, gap 40, jitter 15, apart 5",
        "g g.g.out periodic written: 25 Hz, gap 49, jitter 9, apart 31",
        "h g.h.out event inferred: 100/3 Hz, gap 43, jitter 13, apart 17",
    ]
    assert list_responses(analysis) == [
        "a 2..5 whole way",
        "b 1..6 host",
        "c 2..6 host",
        "d 3..6 host",
        "e 1..6 host",
        "f none ?f..4 cores",
        "g none ?g..9 cores",
        "h none ?h..4 cores",
    ]
    assert list_hosts(analysis) == [
        "p: 1/4 of 1: schedulable; rm 779763147/1000000000, edf 1",
        "  p (1) 1/4",
        "  a 1/10, d 1/10, e 1/20",
        "q: 4/15 of 1: schedulable; rm 207106781/250000000, edf 1",
        "  q (1) 4/15",
        "  b 1/5, c 1/15",
        "r: 13/40 of 2: schedulable; rm none [one core only], edf none [one core only]",
        "  r (2) 13/40",
        "  f 1/20, g 7/40, h 1/10",
    ]


def test_jitter_grows_for_several_rounds() -> None:
    """X and y pass events to and fro: each round makes the jitter larger, which lets more events come at once, until it rests."""
    analysis = analyse_sketch(
        {
            "a @p": "period: 10 ms, wcet: 1 ms, bcet: 1 ms",
            "b @q": "wcet: 2 ms, bcet: 1 ms",
            "c @p": "wcet: 2 ms, bcet: 1 ms",
            "d @q": "wcet: 2 ms, bcet: 1 ms",
            "e @q": "period: 30 ms, wcet: 1 ms",
            "f @p": "period: 20 ms, wcet: 2 ms",
        },
        "a>b b>c c>d",
        "hosts: {p: {cores: 1}, q: {cores: 1}}\nlinks: {lan: {connects: [p, q], latency: {best: 0 ms, worst: 1 ms}}}",
    )
    assert list_paces(analysis) == [
        "a periodic written: 100 Hz, gap 10, jitter 0, apart 10",
        "b event inferred: 100 Hz, gap 28, jitter 18, apart 0",
        "c event inferred: 100 Hz, gap 60, jitter 50, apart 0",
        "d event inferred: 100 Hz, gap 78, jitter 68, apart 0",
        "e periodic written: 100/3 Hz, gap 30, jitter 0, apart 30",
        "f periodic written: 50 Hz, gap 20, jitter 0, apart 20",
    ]
    assert list_responses(analysis) == [
        "a 1..18 host",
        "b 1..32 host",
        "c 1..18 host",
        "d 1..32 host",
        "e none ?e..32 host",
        "f none ?f..18 host",
    ]


def test_several_triggers_of_each_kind() -> None:
    """What fires: the sum of streams, all of them, each n-th, with jitter; calls come beside the triggers and are not thinned."""
    analysis = analyse_sketch(
        {
            "a": "period: 10 ms, jitter: 15 ms, wcet: 1 ms, bcet: 1 ms",
            "b": "period: 20 ms, wcet: 4 ms, bcet: 1 ms",
            "start": "behaviour: once, wcet: 1 ms",
            "any2": "wcet: 1 ms, bcet: 1 ms",
            "all2": "trigger: {all: [a, b]}, wcet: 1 ms",
            "kept": "trigger: {all: [b, start]}, wcet: 1 ms",
            "thin": "trigger: [a], every: 3, jitter: 2 ms, wcet: 1 ms",
            "mixed": "trigger: [a], every: 3, throttle: 12 ms, wcet: 1 ms",
            "ask": "period: 25 ms, wcet: 1 ms, calls: {mixed: 1.5}",
            "burst": "trigger: [a], wcet: 3 ms, bcet: 3 ms",
            "said": "trigger: [a], response: 9 ms, wcet: 3 ms, bcet: 3 ms",
            "x": "trigger: [burst], wcet: 1 ms",
            "y": "trigger: [said], wcet: 1 ms",
            "never": "trigger: {all: [a, gone]}, wcet: 1 ms",
            "hushed": "trigger: {all: [never]}, wcet: 1 ms",
            "other": "trigger: [never, a], wcet: 1 ms",
            "quiet": "trigger: {all: [start]}, wcet: 1 ms",
            "stated": "trigger: [a], period: 70 ms, jitter: 5 ms, wcet: 1 ms",
        },
        "a>any2 b>any2 a>all2 b>all2 b>kept start>kept a>thin a>mixed ask?mixed a>burst a>said burst>x said>y a>never gone>never never>hushed never>other a>other start>quiet a>stated",
    )
    assert list_paces(analysis) == [
        "a periodic written: 100 Hz, gap 25, jitter 15, apart 0",
        "b periodic written: 50 Hz, gap 20, jitter 0, apart 20",
        "start once inferred: 0 Hz, gap none [unbounded], jitter 0, apart none [unbounded]",
        "any2 event inferred: 150 Hz, gap 23, jitter 25, apart 0",
        "all2 event inferred: <= 50 Hz, gap 26, jitter 23, apart 1",
        "kept event inferred: 50 Hz, gap 23, jitter 3, apart 17",
        "thin event inferred: 100/3 Hz, gap 80, jitter 18, apart 12",
        "mixed on_demand inferred: 60 Hz, gap none ?mixed, jitter 26, apart 0",
        "ask periodic written: 40 Hz, gap 25, jitter 0, apart 25",
        "burst event inferred: 100 Hz, gap 26, jitter 16, apart 1",
        "said event inferred: 100 Hz, gap 26, jitter 16, apart 1",
        "x event inferred: 100 Hz, gap 28, jitter 18, apart 3",
        "y event inferred: 100 Hz, gap 32, jitter 22, apart 0",
        "never event inferred: <= 100 ?g.never.gone Hz, gap none ?g.never.gone, jitter 26, apart 0",
        "hushed event inferred: none ?g.never.gone Hz, gap none ?g.never.gone, jitter 29, apart 0",
        "other event inferred: >= 200 ?g.never.gone Hz, gap 26, jitter 33, apart 0",
        "quiet event inferred: 0 Hz, gap none [unbounded], jitter 0, apart none [unbounded]",
        "stated periodic written: 100/7 Hz, gap 75, jitter 5, apart 65",
    ]
    assert list_outputs(analysis) == [
        "a g.a.out periodic written: 100 Hz, gap 26, jitter 16, apart 0",
        "b g.b.out periodic written: 50 Hz, gap 23, jitter 3, apart 17",
        "start g.start.out once inferred: 0 Hz, gap none [unbounded], jitter 1, apart none [unbounded]",
        "any2 g.any2.out event inferred: 150 Hz, gap 25, jitter 27, apart 0",
        "all2 g.all2.out event inferred: <= 50 Hz, gap 27, jitter 24, apart 0",
        "kept g.kept.out event inferred: 50 Hz, gap 24, jitter 4, apart 16",
        "thin g.thin.out event inferred: 100/3 Hz, gap 81, jitter 19, apart 11",
        "mixed g.mixed.serve on_demand inferred: 60 Hz, gap none ?mixed, jitter 28, apart 0",
        "ask g.ask.out periodic written: 40 Hz, gap 26, jitter 1, apart 24",
        "burst g.burst.out event inferred: 100 Hz, gap 28, jitter 18, apart 0",
        "said g.said.out event inferred: 100 Hz, gap 32, jitter 22, apart 0",
        "x g.x.out event inferred: 100 Hz, gap 29, jitter 19, apart 2",
        "y g.y.out event inferred: 100 Hz, gap 35, jitter 25, apart 0",
        "never g.never.out event inferred: <= 100 ?g.never.gone Hz, gap none ?g.never.gone, jitter 29, apart 0",
        "hushed g.hushed.out event inferred: none ?g.never.gone Hz, gap none ?g.never.gone, jitter 32, apart 0",
        "other g.other.out event inferred: >= 200 ?g.never.gone Hz, gap 33, jitter 40, apart 0",
        "quiet g.quiet.out event inferred: 0 Hz, gap none [unbounded], jitter 1, apart none [unbounded]",
        "stated g.stated.out periodic written: 100/7 Hz, gap 76, jitter 6, apart 64",
    ]
    assert list_responses(analysis) == [
        "a 1..2 [assuming a dedicated core] dedicated",
        "b 1..4 [assuming a dedicated core] dedicated",
        "start none ?start..1 [assuming a dedicated core] dedicated",
        "any2 1..3 [assuming a dedicated core] dedicated",
        "all2 none ?all2..1 [assuming a dedicated core] dedicated",
        "kept none ?kept..1 [assuming a dedicated core] dedicated",
        "thin none ?thin..1 [assuming a dedicated core] dedicated",
        "mixed none ?mixed..2 [assuming a dedicated core] dedicated",
        "ask none ?ask..1 [assuming a dedicated core] dedicated",
        "burst 3..5 [assuming a dedicated core] dedicated",
        "said 3..9 [assumed] declared",
        "x none ?x..1 [assuming a dedicated core] dedicated",
        "y none ?y..3 [assuming a dedicated core] dedicated",
        "never none ?never..3 [assuming a dedicated core] dedicated",
        "hushed none ?hushed..3 [assuming a dedicated core] dedicated",
        "other none ?other..7 [assuming a dedicated core] dedicated",
        "quiet none ?quiet..1 [assuming a dedicated core] dedicated",
        "stated none ?stated..1 [assuming a dedicated core] dedicated",
    ]
    assert list_edges(analysis) == [
        "a>any2: loss 0, rereads 1, beat 0, queue 2",
        "a>all2: loss 1/2, rereads 1, beat 0, queue 5",
        "a>thin: loss 2/3, rereads 1, beat 0, queue 1",
        "a>mixed: loss 2/5, rereads 1, beat 50, queue none ?mixed [assuming a dedicated core]",
        "a>burst: loss 0, rereads 1, beat 0, queue 3",
        "a>said: loss 0, rereads 1, beat 0, queue 3",
        "a>never: loss none ?g.never.gone, rereads none ?g.never.gone, beat none ?g.never.gone, queue none ?g.never.gone [assuming a dedicated core]",
        "a>other: loss 0, rereads 1, beat 0, queue 3",
        "a>stated: loss 6/7, rereads 1, beat 0, queue 10",
        "b>any2: loss 0, rereads 1, beat 0, queue 1",
        "b>all2: loss 0, rereads 1, beat 0, queue 2",
        "b>kept: loss 0, rereads 1, beat 0, queue 2",
        "start>kept: loss 0, rereads 1, beat 0, queue 1",
        "start>quiet: loss 0, rereads 1, beat 0, queue 1",
        "burst>x: loss 0, rereads 1, beat 0, queue 1",
        "said>y: loss 0, rereads 1, beat 0, queue 3",
        "never>hushed: loss 0, rereads 1, beat 0, queue 4",
        "never>other: loss 0, rereads 1, beat 0, queue 4",
    ]


def test_what_is_given_up_leaves_no_run_either() -> None:
    """From p to q and back: each makes the other late without end. Runs of the last turn are below the truth, not bounds.

    `x`, elsewhere, fires the second step of such a run: what it leads to has no bound.
    """
    fired = "behaviour: event, trigger: any, wcet: 3500 us, bcet: 0 ms"
    nodes = {"n0 @p": "period: 20 ms, wcet: 3500 us, bcet: 0 ms"}
    nodes |= {f"n{at} @{'pq'[at // 2 % 2]}": fired for at in range(1, 8)}
    nodes["x @r"] = "period: 1 s, wcet: 1 us"
    wires = " ".join(f"n{at}>n{at + 1}" for at in range(7)) + " x>n5"
    rest = (
        "hosts: {p: {cores: 1}, q: {cores: 1}, r: {cores: 1}}\n"
        "links: {lan: {connects: [p, q, r], latency: 0 ms}}\nchains: {c: {through: [g.x, g.n5]}}"
    )
    analysis = analyse_sketch(nodes, wires, rest)
    assert analysis.diverged == tuple(f"n{at}" for at in range(8))
    assert analysis.runs == {}
    assert (
        show_ms(bound_all_chains(analysis, read_sketch(nodes, wires, rest))["c"].bound)
        == ">= 1000001/1000 ? [diverged]"
    )
