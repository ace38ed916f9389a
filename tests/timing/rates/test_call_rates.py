"""Servers and callers: how often calls come, how long answers take, what becomes of those who wait."""

from __future__ import annotations

from tests.timing.sketches import (
    analyse_sketch,
    list_edges,
    list_outputs,
    list_paces,
    list_reasons,
    list_responses,
    list_services,
    list_topics,
)


def test_calls_of_several_callers() -> None:
    """40 + 5 Hz: two calls each 50 ms, half a one each 100 ms. Three may be there at once: 3 x 4 ms. `poll` looks each 20 ms: 20 + 2."""
    analysis = analyse_sketch(
        {
            "server": "wcet: 4 ms, bcet: 2 ms",
            "a": "period: 50 ms, wcet: 1 ms, bcet: 1 ms, calls: {server: 2}",
            "b": "period: 100 ms, wcet: 1 ms, calls: {server: 0.5}",
            "idle": "wcet: 1 ms",
            "poll": "period: 20 ms, wcet: 2 ms, bcet: 1 ms",
            "mixed": "behaviour: event, wcet: 1 ms, bcet: 1 ms",
            "c": "period: 25 ms, wcet: 1 ms",
            "unheard": "behaviour: on_demand, wcet: 1 ms",
        },
        "a?server b?server c?poll c?mixed a>mixed mixed>idle",
    )
    assert list_paces(analysis) == [
        "server on_demand inferred: 45 Hz, gap none ?server, jitter 79, apart 0",
        "a periodic written: 20 Hz, gap 50, jitter 0, apart 50",
        "b periodic written: 10 Hz, gap 100, jitter 0, apart 100",
        "idle event inferred: 60 Hz, gap 51, jitter 35, apart 0",
        "poll periodic written: 50 Hz, gap 20, jitter 0, apart 20",
        "mixed event inferred: 60 Hz, gap 50, jitter 34, apart 0",
        "c periodic written: 40 Hz, gap 25, jitter 0, apart 25",
        "unheard on_demand inferred: none ?unheard Hz, gap none ?unheard, jitter none ?unheard, apart none ?unheard",
    ]
    assert list_reasons(analysis) == [
        "server: called by a, 2 times for each activation: 40 Hz @14:77 | called by b, 0.5 times for each activation: 5 Hz @15:66",
        "a: every 50 ms, as written @14:39",
        "b: every 100 ms, as written @15:39",
        "idle: g.idle.mixed brings 60 Hz from mixed, at most 51 ms apart @7:30",
        "poll: every 20 ms, as written @17:45",
        "mixed: g.mixed.a brings 20 Hz from a, at most 50 ms apart @9:27 | called by c, once for each activation: 40 Hz @10:45",
        "c: every 25 ms, as written @19:39",
        "unheard: on demand, and nobody is known to call it @20:34",
        "server takes: its own queue, on a core of its own @13:47",
        "a takes: its own queue, on a core of its own @14:52",
        "b takes: its own queue, on a core of its own @15:53",
        "idle takes: its own queue, on a core of its own @16:43",
        "poll takes: its own queue, on a core of its own @17:58",
        "mixed takes: its own queue, on a core of its own @18:63",
        "c takes: its own queue, on a core of its own @19:52",
        "unheard takes: its own queue, on a core of its own @20:71",
    ]
    assert list_outputs(analysis) == [
        "server g.server.serve on_demand inferred: 45 Hz, gap none ?server, jitter 89, apart 0",
        "a g.a.out periodic written: 20 Hz, gap 50, jitter 0, apart 50",
        "b g.b.out periodic written: 10 Hz, gap 101, jitter 1, apart 99",
        "idle g.idle.out event inferred: 60 Hz, gap 53, jitter 37, apart 0",
        "poll g.poll.serve periodic written: none ?poll Hz, gap none ?poll, jitter 1, apart 19",
        "mixed g.mixed.out event inferred: 60 Hz, gap 51, jitter 35, apart 0",
        "mixed g.mixed.serve event inferred: 40 Hz, gap none ?mixed, jitter 35, apart 0",
        "c g.c.out periodic written: 40 Hz, gap 26, jitter 1, apart 24",
        "unheard g.unheard.out on_demand inferred: none ?unheard Hz, gap none ?unheard, jitter >= none ?unheard [assuming a dedicated core], apart none ?",
    ]
    assert list_responses(analysis) == [
        "server 2..12 [assuming a dedicated core] dedicated",
        "a 1..1 [assuming a dedicated core] dedicated",
        "b none ?b..1 [assuming a dedicated core] dedicated",
        "idle none ?idle..2 [assuming a dedicated core] dedicated",
        "poll 1..2 [assuming a dedicated core] dedicated",
        "mixed 1..2 [assuming a dedicated core] dedicated",
        "c none ?c..1 [assuming a dedicated core] dedicated",
        "unheard none ?unheard..>= 1 ?unheard [assuming a dedicated core] dedicated",
    ]
    assert list_topics(analysis) == [
        "/g/a/out: 1000 B, 20000 B/s published, 20000 delivered",
        "/g/b/out: 1000 B, 10000 B/s published, 0 delivered",
        "/g/idle/out: 1000 B, 60000 B/s published, 0 delivered",
        "/g/mixed/out: 1000 B, 60000 B/s published, 60000 delivered",
        "/g/c/out: 1000 B, 40000 B/s published, 0 delivered",
        "/g/unheard/out: 1000 B, none ?unheard B/s published, 0 delivered",
    ]
    assert list_edges(analysis) == [
        "a>mixed: loss 0, rereads 1, beat 0, queue 1",
        "mixed>idle: loss 0, rereads 1, beat 0, queue 2",
    ]
    assert list_services(analysis) == [
        "server asked by a,b: 12 [assuming a dedicated core]; a waits 24 [assuming a dedicated core] takes 25 [assuming a dedicated core], b waits 12 [assuming a dedicated core] takes 13 [assuming a dedicated core]",
        "poll asked by c: 22 [assuming a dedicated core]; c waits 22 [assuming a dedicated core] takes 23 [assuming a dedicated core]",
        "mixed asked by c: 2 [assuming a dedicated core]; c waits 2 [assuming a dedicated core] takes 3 [assuming a dedicated core]",
    ]


def test_servers_whose_response_is_open() -> None:
    """A server on a core of its own takes K C as long as its callers wait; on a host that is full nothing is known."""
    analysis = analyse_sketch(
        {
            "own": "wcet: 4 ms",
            "dark": "",
            "said": "response: 9 ms",
            "full @pc": "wcet: 20 ms",
            "brief": "response: 1 ms, wcet: 3 ms",
            "x": "",
            "y": "period: 10 ms, wcet: 1 ms, calls: {full: 1, said: 3}",
            "z": "period: 5 ms, wcet: 1 ms, calls: {own: 2.5}",
            "poll": "behaviour: periodic, wcet: 1 ms",
            "slow @far": "wcet: 2 ms",
            "w @near": "period: 20 ms, wcet: 1 ms, calls: {slow: 3}",
        },
        "x?own z?own x?dark y?said y?full y?brief x?brief z?poll w?slow",
        "hosts: {pc: {cores: 1}, far: {cores: 1}, near: {cores: 1}}\n"
        "links: {lan: {connects: [near, far], latency: {best: 1 ms, worst: 4 ms}}}",
    )
    assert list_paces(analysis) == [
        "own on_demand inferred: >= 500 ?x Hz, gap none ?own, jitter none ?x, apart none ?x",
        "dark on_demand inferred: none ?x Hz, gap none ?dark, jitter none ?x, apart none ?x",
        "said on_demand inferred: 300 Hz, gap none ?said, jitter 11, apart 0",
        "full on_demand inferred: 100 Hz, gap none ?full, jitter none ?y,full [no link joins their hosts], apart none ?y,full [no link joins their hosts]",
        "brief on_demand inferred: >= 100 ?x Hz, gap none ?brief, jitter none ?x, apart none ?x",
        "x None inferred: none ?x Hz, gap none ?x, jitter none ?x, apart none ?x",
        "y periodic written: 100 Hz, gap 10, jitter 0, apart 10",
        "z periodic written: 200 Hz, gap 5, jitter 0, apart 5",
        "poll periodic inferred: none ?poll Hz, gap none ?poll, jitter none ?poll, apart none ?poll",
        "slow on_demand inferred: 150 Hz, gap none ?slow, jitter 24, apart 0",
        "w periodic written: 50 Hz, gap 20, jitter 0, apart 20",
    ]
    assert list_reasons(analysis) == [
        "own: called by x, once for each activation: unknown @9:25 | called by z, 2.5 times for each activation: 500 Hz @23:64",
        "dark: called by x, once for each activation: unknown @9:42",
        "said: called by y, 3 times for each activation: 300 Hz @22:65",
        "full: called by y, once for each activation: 100 Hz @22:65",
        "brief: called by x, once for each activation: unknown @9:61 | called by y, once for each activation: 100 Hz @10:63",
        "x: nothing says when it runs @21:3",
        "y: every 10 ms, as written @22:39",
        "z: every 5 ms, as written @23:39",
        "poll: periodic, but neither a period nor a rate is written @24:28",
        "slow: called by w, 3 times for each activation: 150 Hz @26:77",
        "w: every 20 ms, as written @26:51",
        "own takes: its own queue, on a core of its own @16:41",
        "dark takes: no execution time is written @17:3",
        "said takes: declared as the worst case @18:47",
        "full takes: the longest time for which all work on pc can keep it busy, in whatever order @19:53",
        "brief takes: declared as the worst case @20:49",
        "x takes: no execution time is written @21:3",
        "y takes: its own queue, on a core of its own @22:52",
        "z takes: its own queue, on a core of its own @23:51",
        "poll takes: its own queue, on a core of its own @24:64",
        "slow takes: the longest time for which all work on far can keep it busy, in whatever order @25:54",
        "w takes: the longest time for which all work on near can keep it busy, in whatever order @26:64",
    ]
    assert list_outputs(analysis) == [
        "own g.own.serve on_demand inferred: >= 500 ?x Hz, gap none ?own, jitter >= none ?x [assuming a dedicated core], apart none ?",
        "dark g.dark.serve on_demand inferred: none ?x Hz, gap none ?dark, jitter >= none ?x,dark, apart none ?",
        "said g.said.serve on_demand inferred: 300 Hz, gap none ?said, jitter 20, apart 0",
        "full g.full.serve on_demand inferred: 100 Hz, gap none ?full, jitter >= none ?y,full [no link joins their hosts], apart none ?",
        "brief g.brief.serve on_demand inferred: >= 100 ?x Hz, gap none ?brief, jitter >= 1 ?x, apart none ?",
        "x g.x.out None inferred: none ?x Hz, gap none ?x, jitter >= none ?x, apart none ?",
        "y g.y.out periodic written: 100 Hz, gap 11, jitter 1, apart 9",
        "z g.z.out periodic written: 200 Hz, gap 6, jitter 1, apart 4",
        "poll g.poll.serve periodic inferred: none ?poll Hz, gap none ?poll, jitter >= none ?poll [assuming a dedicated core], apart none ?",
        "slow g.slow.serve on_demand inferred: 150 Hz, gap none ?slow, jitter 30, apart 0",
        "w g.w.out periodic written: 50 Hz, gap 21, jitter 1, apart 19",
    ]
    assert list_responses(analysis) == [
        "own none ?own..>= 4 ?x [assuming a dedicated core] dedicated",
        "dark none ?dark..>= none ?dark,x unknown",
        "said none ?said..9 [assumed] declared",
        "full none ?full..>= 20 ?y,full [no link joins their hosts] host",
        "brief none ?brief..1 [assumed] declared",
        "x none ?x..>= none ?x unknown",
        "y none ?y..1 [assuming a dedicated core] dedicated",
        "z none ?z..1 [assuming a dedicated core] dedicated",
        "poll none ?poll..>= 1 ?poll [assuming a dedicated core] dedicated",
        "slow none ?slow..6 host",
        "w none ?w..1 host",
    ]
    assert list_services(analysis) == [
        "own asked by x,z: 8 [assuming a dedicated core; callers call again only when they have been answered]; x waits 8 [assuming a dedicated core; callers call again only when they have been answered] takes >= 8 ?x [assuming a dedicated core; callers call again only when they have been answered], z waits 24 [assuming a dedicated core; callers call again only when they have been answered] takes 25 [assuming a dedicated core; callers call again only when they have been answered]",
        "dark asked by x: none ?dark; x waits >= 0 ?dark takes >= 0 ?x,dark",
        "said asked by y: 9 [assumed]; y waits 27 [assumed] takes 28 [assuming a dedicated core; assumed]",
        "full asked by y: >= 20 ?y,full [no link joins their hosts]; y waits >= 20 ?y,full [no link joins their hosts] takes >= 21 ?y,full [assuming a dedicated core; no link joins their hosts]",
        "brief asked by x,y: 1 [assumed]; x waits 1 [assumed] takes >= 1 ?x [assumed], y waits 1 [assumed] takes 2 [assuming a dedicated core; assumed]",
        "poll asked by z: >= 1 ?poll [assuming a dedicated core]; z waits >= 1 ?poll [assuming a dedicated core] takes >= 2 ?poll [assuming a dedicated core]",
        "slow asked by w: 6; w waits 42 takes 43",
    ]


def test_a_caller_of_whose_timing_nothing_is_written_gives_no_rate() -> None:
    """One call for each message that it reads would be a guess, and an overload that follows from it, too."""
    analysis = analyse_sketch(
        {"server": "wcet: 300 ms", "sensor": "rate: 100 Hz, wcet: 1 ms", "asker": ""},
        "sensor>asker asker?server",
    )
    assert list_paces(analysis)[0].startswith("server on_demand inferred: none ?asker Hz")
    assert "called by asker, once for each activation: unknown" in list_reasons(analysis)[0]
