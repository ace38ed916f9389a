"""Rates, gaps and event models of everything that a clock, an input or nobody fires, with every reason and its place."""

from __future__ import annotations

import pytest

from archgen.timing.run_analysis import analyse_architecture
from tests.timing.printed import show, show_ms
from tests.timing.random_systems import architecture
from tests.timing.sketches import (
    analyse_sketch,
    list_edges,
    list_outputs,
    list_paces,
    list_reasons,
    list_responses,
    list_topics,
)


def test_clocks_inputs_and_what_nobody_wrote() -> None:
    """Any-of adds rates and takes the smallest gap, all-of the other way round (docs/timing.md). Of `clock` 12 = 10 + 2 is the gap.
    `thin` has one in 3: 36. `slow` lets pass each third, since 25 > 2 periods: less than 12 + 25, and 4 late.
    """
    analysis = analyse_sketch(
        {
            "clock": "period: 10 ms, jitter: 2 ms, wcet: 1 ms, bcet: 1 ms",
            "lazy": "rate: 4 Hz, wcet: 2 ms",
            "mute": "",
            "start": "behaviour: once, wcet: 3 ms",
            "silent": "behaviour: periodic",
            "reader": "wcet: 3 ms, bcet: 1 ms",
            "thin": "trigger: [clock], every: 3, wcet: 1 ms, bcet: 1 ms",
            "slow": "trigger: [clock], throttle: 25 ms, jitter: 4 ms, wcet: 1 ms",
            "kept": "trigger: {all: [start]}, wcet: 1 ms",
            "both": "trigger: {all: [clock, lazy, start]}, wcet: 1 ms",
            "pair": "trigger: {all: [clock, mute]}",
            "own": "behaviour: event, trigger: [clock], period: 40 ms, wcet: 1 ms",
            "world": "behaviour: event, trigger: [sky], wcet: 1 ms",
            "lone": "behaviour: event",
        },
        "clock>reader lazy>reader clock>thin clock>slow start>kept clock>both lazy>both start>both clock>pair mute>pair clock>own sky>world",
    )
    assert list_paces(analysis) == [
        "clock periodic written: 100 Hz, gap 12, jitter 2, apart 8",
        "lazy periodic written: 4 Hz, gap 250, jitter 0, apart 250",
        "mute None inferred: none ?mute Hz, gap none ?mute, jitter none ?mute, apart none ?mute",
        "start once inferred: 0 Hz, gap none [unbounded], jitter 0, apart none [unbounded]",
        "silent periodic inferred: none ?silent Hz, gap none ?silent, jitter none ?silent, apart none ?silent",
        "reader event inferred: 104 Hz, gap 12, jitter 22, apart 0",
        "thin event inferred: 100/3 Hz, gap 36, jitter 2, apart 28",
        "slow event inferred: 100/3 Hz, gap 41, jitter 6, apart 24",
        "kept event inferred: 0 Hz, gap none [unbounded], jitter 0, apart none [unbounded]",
        "both event inferred: <= 4 Hz, gap 252, jitter 252, apart 8",
        "pair event inferred: <= 100 ?mute Hz, gap none ?mute, jitter 12, apart 0",
        "own event written: 25 Hz, gap 40, jitter 0, apart 40",
        "world event inferred: none ?g.world.sky Hz, gap none ?g.world.sky, jitter none ?g.world.sky, apart none ?g.world.sky",
        "lone event inferred: none ?lone Hz, gap none ?lone, jitter none ?lone, apart none ?lone",
    ]
    assert list_reasons(analysis) == [
        "clock: every 10 ms, up to 2 ms later, as written @19:47",
        "lazy: every 250 ms, as written @20:43",
        "mute: nothing says when it runs @21:3",
        "start: published once, at the start @22:30",
        "silent: periodic, but neither a period nor a rate is written @23:32",
        "reader: fired by any of its triggers: rates add up, the smallest gap counts @24:32 | g.reader.clock brings 100 Hz from clock, at most 12 ms apart @9:32 | g.reader.lazy brings 4 Hz from lazy, at most 252 ms apart @9:49",
        "thin: g.thin.clock brings 100 Hz from clock, at most 12 ms apart @10:30 | one in 3 fires it @25:62",
        "slow: g.slow.clock brings 100 Hz from clock, at most 12 ms apart @11:30 | throttled: at least 25 ms apart @26:65",
        "kept: fires when all of its triggers have something new: with the smallest rate, and the largest gap @27:46 | g.kept.start is sent once and kept: it is always there @27:28",
        "both: fires when all of its triggers have something new: with the smallest rate, and the largest gap @28:46 | g.both.clock brings 100 Hz from clock, at most 12 ms apart @13:30 | g.both.lazy brings 4 Hz from lazy, at most 252 ms apart @13:47 | g.both.start is sent once and kept: it is always there @28:28",
        "pair: fires when all of its triggers have something new: with the smallest rate, and the largest gap @29:46 | g.pair.clock brings 100 Hz from clock, at most 12 ms apart @14:30 | g.pair.mute brings unknown from mute @14:47",
        "own: every 40 ms, as written @30:79",
        "world: how often g.world.sky brings something is not known @31:30",
        "lone: event-driven, but no input fires it @32:28",
        "clock takes: its own queue, on a core of its own @19:74",
        "lazy takes: its own queue, on a core of its own @20:55",
        "mute takes: no execution time is written @21:3",
        "start takes: its own queue, on a core of its own @22:62",
        "silent takes: no execution time is written @23:32",
        "reader takes: its own queue, on a core of its own @24:47",
        "thin takes: its own queue, on a core of its own @25:71",
        "slow takes: its own queue, on a core of its own @26:92",
        "kept takes: its own queue, on a core of its own @27:68",
        "both takes: its own queue, on a core of its own @28:81",
        "pair takes: no execution time is written @29:28",
        "own takes: its own queue, on a core of its own @30:92",
        "world takes: its own queue, on a core of its own @31:79",
        "lone takes: no execution time is written @32:28",
    ]
    assert list_outputs(analysis) == [
        "clock g.clock.out periodic written: 100 Hz, gap 12, jitter 2, apart 8",
        "lazy g.lazy.out periodic written: 4 Hz, gap 252, jitter 2, apart 248",
        "mute g.mute.out None inferred: none ?mute Hz, gap none ?mute, jitter >= none ?mute, apart none ?",
        "start g.start.out once inferred: 0 Hz, gap none [unbounded], jitter 3, apart none [unbounded]",
        "silent g.silent.out periodic inferred: none ?silent Hz, gap none ?silent, jitter >= none ?silent, apart none ?",
        "reader g.reader.out event inferred: 104 Hz, gap 17, jitter 27, apart 0",
        "thin g.thin.out event inferred: 100/3 Hz, gap 36, jitter 2, apart 28",
        "slow g.slow.out event inferred: 100/3 Hz, gap 42, jitter 7, apart 23",
        "kept g.kept.out event inferred: 0 Hz, gap none [unbounded], jitter 1, apart none [unbounded]",
        "both g.both.out event inferred: <= 4 Hz, gap 253, jitter 253, apart 7",
        "pair g.pair.out event inferred: <= 100 ?mute Hz, gap none ?mute, jitter >= 12 ?pair, apart 0",
        "own g.own.out event written: 25 Hz, gap 41, jitter 1, apart 39",
        "world g.world.out event inferred: none ?g.world.sky Hz, gap none ?g.world.sky, jitter >= none ?g.world.sky [assuming a dedicated core], apart none ?",
        "lone g.lone.out event inferred: none ?lone Hz, gap none ?lone, jitter >= none ?lone, apart none ?",
    ]
    assert list_responses(analysis) == [
        "clock 1..1 [assuming a dedicated core] dedicated",
        "lazy none ?lazy..2 [assuming a dedicated core] dedicated",
        "mute none ?mute..>= none ?mute unknown",
        "start none ?start..3 [assuming a dedicated core] dedicated",
        "silent none ?silent..>= none ?silent unknown",
        "reader 1..6 [assuming a dedicated core] dedicated",
        "thin 1..1 [assuming a dedicated core] dedicated",
        "slow none ?slow..1 [assuming a dedicated core] dedicated",
        "kept none ?kept..1 [assuming a dedicated core] dedicated",
        "both none ?both..1 [assuming a dedicated core] dedicated",
        "pair none ?pair..>= none ?pair unknown",
        "own none ?own..1 [assuming a dedicated core] dedicated",
        "world none ?world..>= 1 ?g.world.sky [assuming a dedicated core] dedicated",
        "lone none ?lone..>= none ?lone unknown",
    ]
    assert list_topics(analysis) == [
        "/g/clock/out: 1000 B, 100000 B/s published, 600000 delivered",
        "/g/lazy/out: 1000 B, 4000 B/s published, 8000 delivered",
        "/g/mute/out: 1000 B, none ?mute B/s published, none ?mute delivered",
        "/g/start/out: 1000 B, 0 B/s published, 0 delivered",
        "/g/silent/out: 1000 B, none ?silent B/s published, 0 delivered",
        "/g/reader/out: 1000 B, 104000 B/s published, 0 delivered",
        "/g/thin/out: 1000 B, 100000/3 B/s published, 0 delivered",
        "/g/slow/out: 1000 B, 100000/3 B/s published, 0 delivered",
        "/g/kept/out: 1000 B, 0 B/s published, 0 delivered",
        "/g/both/out: 1000 B, <= 4000 B/s published, 0 delivered",
        "/g/pair/out: 1000 B, <= 100000 ?mute B/s published, 0 delivered",
        "/g/own/out: 1000 B, 25000 B/s published, 0 delivered",
        "/g/world/out: 1000 B, none ?g.world.sky B/s published, 0 delivered",
        "/g/lone/out: 1000 B, none ?lone B/s published, 0 delivered",
    ]
    assert list_edges(analysis) == [
        "clock>reader: loss 0, rereads 1, beat 0, queue 1",
        "clock>thin: loss 2/3, rereads 1, beat 0, queue 1",
        "clock>slow: loss 2/3, rereads 1, beat 0, queue 1",
        "clock>both: loss 24/25, rereads 1, beat 0, queue 26",
        "clock>pair: loss none ?mute, rereads none ?mute, beat none ?mute, queue none ?mute,pair",
        "clock>own: loss 0, rereads 1, beat 0, queue 1",
        "lazy>reader: loss 0, rereads 1, beat 0, queue 1",
        "lazy>both: loss 0, rereads 1, beat 0, queue 2",
        "mute>pair: loss >= none ?mute, rereads >= none ?mute, beat >= none ?mute, queue none ?mute",
        "start>kept: loss 0, rereads 1, beat 0, queue 1",
        "start>both: loss 0, rereads 1, beat 0, queue 1",
    ]


def test_throttles_and_what_fires_them() -> None:
    """A throttle of 15 after a clock of 10 passes each second one: 20. One of 10 passes all, one of 5 as well. With jitter 8 an
    earlier one may pass: only 1 / 15 ms is sure. What nobody knows is taken to come regularly.
    """
    analysis = analyse_sketch(
        {
            "clock": "period: 10 ms, wcet: 0 ms, bcet: 0 ms",
            "loose": "period: 10 ms, jitter: 8 ms, wcet: 0 ms, bcet: 0 ms",
            "dark": "period: 10 ms",
            "x": "trigger: [clock], throttle: 15 ms, wcet: 0 ms",
            "y": "trigger: [clock], throttle: 10 ms, wcet: 0 ms",
            "z": "trigger: [clock], throttle: 5 ms, wcet: 0 ms",
            "late": "trigger: [loose], throttle: 15 ms, wcet: 0 ms",
            "either": "trigger: [clock, loose], throttle: 15 ms, wcet: 0 ms",
            "guess": "trigger: [dark], throttle: 15 ms, wcet: 0 ms",
            "even": "trigger: [dark], throttle: 10 ms, wcet: 0 ms",
            "nothing": "trigger: [mute], throttle: 15 ms",
            "mute": "",
            "half": "trigger: [dark, mute], throttle: 25 ms",
            "deaf": "behaviour: event, throttle: 4 ms",
            "twice": "trigger: [clock], every: 2, throttle: 30 ms, wcet: 0 ms",
            "sometimes": "period: 10 ms, wcet: 0 ms, outputs: {out: {conditional: true}}",
            "rare": "trigger: [sometimes], throttle: 15 ms, wcet: 0 ms",
        },
        "clock>x clock>y clock>z loose>late clock>either loose>either dark>guess dark>even mute>nothing dark>half mute>half clock>twice sometimes>rare",
    )
    assert list_paces(analysis) == [
        "clock periodic written: 100 Hz, gap 10, jitter 0, apart 10",
        "loose periodic written: 100 Hz, gap 18, jitter 8, apart 2",
        "dark periodic written: 100 Hz, gap 10, jitter 0, apart 10",
        "x event inferred: 50 Hz, gap 25, jitter 0, apart 20",
        "y event inferred: 100 Hz, gap 20, jitter 0, apart 10",
        "z event inferred: 100 Hz, gap 15, jitter 0, apart 10",
        "late event inferred: <= 200/3 Hz, gap 33, jitter 8, apart 15",
        "either event inferred: <= 200/3 Hz, gap 25, jitter 14, apart 15",
        "guess event inferred: 50 [what fires it is taken to come regularly] Hz, gap >= 25 ?dark, jitter none ?dark, apart none ?dark",
        "even event inferred: 100 [what fires it is taken to come regularly] Hz, gap >= 20 ?dark, jitter none ?dark, apart none ?dark",
        "nothing event inferred: none ?mute Hz, gap none ?mute, jitter none ?mute, apart none ?mute",
        "mute None inferred: none ?mute Hz, gap none ?mute, jitter none ?mute, apart none ?mute",
        "half event inferred: >= 40 ?mute Hz, gap none ?dark,mute, jitter none ?dark,mute, apart none ?dark,mute",
        "deaf event inferred: none ?deaf Hz, gap none ?deaf, jitter none ?deaf, apart none ?deaf",
        "twice event inferred: 25 Hz, gap 50, jitter 0, apart 40",
        "sometimes periodic written: 100 Hz, gap 10, jitter 0, apart 10",
        "rare event inferred: <= 50 [conditional: between none and this] Hz, gap none [unbounded], jitter 0, apart 20",
    ]
    assert list_reasons(analysis) == [
        "clock: every 10 ms, as written @22:47",
        "loose: every 10 ms, up to 8 ms later, as written @23:47",
        "dark: every 10 ms, as written @24:45",
        "x: g.x.clock brings 100 Hz from clock, at most 10 ms apart @7:27 | throttled: at least 15 ms apart @25:59",
        "y: g.y.clock brings 100 Hz from clock, at most 10 ms apart @8:27 | throttled: at least 10 ms apart @26:59",
        "z: g.z.clock brings 100 Hz from clock, at most 10 ms apart @9:27 | throttled: at least 5 ms apart @27:59",
        "late: g.late.loose brings 100 Hz from loose, at most 18 ms apart @10:30 | throttled: at least 15 ms apart @28:65",
        "either: fired by any of its triggers: rates add up, the smallest gap counts @29:50 | g.either.clock brings 100 Hz from clock, at most 10 ms apart @11:32 | g.either.loose brings 100 Hz from loose, at most 18 ms apart @11:50 | throttled: at least 15 ms apart @29:76",
        "guess: g.guess.dark brings 100 Hz from dark @12:30 | throttled: at least 15 ms apart @30:66",
        "even: g.even.dark brings 100 Hz from dark @13:29 | throttled: at least 10 ms apart @31:64",
        "nothing: g.nothing.mute brings unknown from mute @14:32 | throttled: at least 15 ms apart @32:70",
        "mute: nothing says when it runs @33:3",
        "half: fired by any of its triggers: rates add up, the smallest gap counts @34:46 | g.half.dark brings 100 Hz from dark @16:29 | g.half.mute brings unknown from mute @16:45 | throttled: at least 25 ms apart @34:70",
        "deaf: event-driven, but no input fires it @35:28",
        "twice: g.twice.clock brings 100 Hz from clock, at most 10 ms apart @18:31 | one in 2 fires it @36:64 | throttled: at least 30 ms apart @36:77",
        "sometimes: every 10 ms, as written @37:55",
        "rare: g.rare.sometimes brings at most 100 Hz from sometimes @20:34 | throttled: at least 15 ms apart @38:69",
        "clock takes: its own queue, on a core of its own @22:60",
        "loose takes: its own queue, on a core of its own @23:74",
        "dark takes: no execution time is written @24:28",
        "x takes: its own queue, on a core of its own @25:72",
        "y takes: its own queue, on a core of its own @26:72",
        "z takes: its own queue, on a core of its own @27:71",
        "late takes: its own queue, on a core of its own @28:78",
        "either takes: its own queue, on a core of its own @29:89",
        "guess takes: its own queue, on a core of its own @30:79",
        "even takes: its own queue, on a core of its own @31:77",
        "nothing takes: no execution time is written @32:34",
        "mute takes: no execution time is written @33:3",
        "half takes: no execution time is written @34:28",
        "deaf takes: no execution time is written @35:28",
        "twice takes: its own queue, on a core of its own @36:90",
        "sometimes takes: its own queue, on a core of its own @37:68",
        "rare takes: its own queue, on a core of its own @38:82",
    ]
    assert list_edges(analysis) == [
        "clock>x: loss 1/2, rereads 1, beat 0, queue 1",
        "clock>y: loss 0, rereads 1, beat 0, queue 1",
        "clock>z: loss 0, rereads 1, beat 0, queue 1",
        "clock>either: loss 2/3, rereads 1, beat 0, queue 1",
        "clock>twice: loss 3/4, rereads 1, beat 0, queue 1",
        "loose>late: loss 1/3, rereads 1, beat 0, queue 1",
        "loose>either: loss 2/3, rereads 1, beat 0, queue 1",
        "dark>guess: loss 1/2 [what fires it is taken to come regularly], rereads 1, beat 0, queue none ?dark",
        "dark>even: loss 0 [what fires it is taken to come regularly], rereads 1, beat 0, queue none ?dark",
        "dark>half: loss 0, rereads 1, beat 0, queue none ?dark",
        "mute>nothing: loss >= none ?mute, rereads 1, beat 0, queue none ?mute",
        "mute>half: loss 0, rereads 1, beat 0, queue none ?mute",
        "sometimes>rare: loss 1/2 [conditional: between none and this], rereads 1, beat 0, queue 1",
    ]


def test_all_of_several_rates() -> None:
    """All-of takes the smallest rate; exact only where all inputs are strictly periodic, since with jitter one may miss its partner."""
    analysis = analyse_sketch(
        {
            "a": "period: 10 ms, wcet: 0 ms, bcet: 0 ms",
            "b": "period: 25 ms, wcet: 0 ms, bcet: 0 ms",
            "c": "period: 20 ms, jitter: 1 ms, wcet: 0 ms, bcet: 0 ms",
            "d": "period: 40 ms, wcet: 3 ms, bcet: 1 ms",
            "m": "",
            "n": "",
            "start": "behaviour: once",
            "exact": "trigger: {all: [a, b]}, wcet: 1 ms",
            "loose": "trigger: {all: [a, c]}",
            "late": "trigger: {all: [a, d]}, wcet: 1 ms",
            "open": "trigger: {all: [a, m, b]}",
            "dark": "trigger: {all: [m, n]}",
            "one": "trigger: {all: [c]}",
            "fed": "trigger: {all: [start]}, every: 2",
            "world": "trigger: {all: [a, sky]}",
            "thinned": "trigger: [a], every: 2, wcet: 0 ms",
            "merged": "trigger: [a, b], wcet: 0 ms",
            "mixed": "trigger: {all: [merged, a]}",
            "q": "trigger: {all: [thinned, a]}",
        },
        "a>exact b>exact a>loose c>loose a>late d>late a>open m>open b>open m>dark n>dark c>one start>fed a>world sky>world a>thinned a>merged b>merged merged>mixed a>mixed thinned>q a>q",
    )
    assert list_paces(analysis) == [
        "a periodic written: 100 Hz, gap 10, jitter 0, apart 10",
        "b periodic written: 40 Hz, gap 25, jitter 0, apart 25",
        "c periodic written: 50 Hz, gap 21, jitter 1, apart 19",
        "d periodic written: 25 Hz, gap 40, jitter 0, apart 40",
        "m None inferred: none ?m Hz, gap none ?m, jitter none ?m, apart none ?m",
        "n None inferred: none ?n Hz, gap none ?n, jitter none ?n, apart none ?n",
        "start once inferred: 0 Hz, gap none [unbounded], jitter 0, apart none [unbounded]",
        "exact event inferred: 40 Hz, gap 25, jitter 25, apart 10",
        "loose event inferred: <= 50 Hz, gap 21, jitter 21, apart 10",
        "late event inferred: <= 25 Hz, gap 42, jitter 42, apart 10",
        "open event inferred: <= 40 ?m Hz, gap none ?m, jitter 25, apart 0",
        "dark event inferred: none ?m,n Hz, gap none ?m,n, jitter none ?m,n, apart none ?m,n",
        "one event inferred: 50 Hz, gap 21, jitter 1, apart 19",
        "fed event inferred: 0 Hz, gap none [unbounded], jitter 0, apart none [unbounded]",
        "world event inferred: <= 100 ?g.world.sky Hz, gap none ?g.world.sky, jitter 10, apart 0",
        "thinned event inferred: 50 Hz, gap 20, jitter 0, apart 20",
        "merged event inferred: 140 Hz, gap 10, jitter 15, apart 0",
        "mixed event inferred: <= 100 Hz, gap 10, jitter 10, apart 0",
        "q event inferred: 50 Hz, gap 20, jitter 20, apart 10",
    ]
    assert list_reasons(analysis) == [
        "a: every 10 ms, as written @24:39",
        "b: every 25 ms, as written @25:39",
        "c: every 20 ms, up to 1 ms later, as written @26:39",
        "d: every 40 ms, as written @27:39",
        "m: nothing says when it runs @28:3",
        "n: nothing says when it runs @29:3",
        "start: published once, at the start @30:30",
        "exact: fires when all of its triggers have something new: with the smallest rate, and the largest gap @31:48 | g.exact.a brings 100 Hz from a, at most 10 ms apart @11:27 | g.exact.b brings 40 Hz from b, at most 25 ms apart @11:37",
        "loose: fires when all of its triggers have something new: with the smallest rate, and the largest gap @32:48 | g.loose.a brings 100 Hz from a, at most 10 ms apart @12:27 | g.loose.c brings 50 Hz from c, at most 21 ms apart @12:37",
        "late: fires when all of its triggers have something new: with the smallest rate, and the largest gap @33:46 | g.late.a brings 100 Hz from a, at most 10 ms apart @13:26 | g.late.d brings 25 Hz from d, at most 42 ms apart @13:36",
        "open: fires when all of its triggers have something new: with the smallest rate, and the largest gap @34:46 | g.open.a brings 100 Hz from a, at most 10 ms apart @14:26 | g.open.m brings unknown from m @14:36 | g.open.b brings 40 Hz from b, at most 25 ms apart @14:46",
        "dark: fires when all of its triggers have something new: with the smallest rate, and the largest gap @35:46 | g.dark.m brings unknown from m @15:26 | g.dark.n brings unknown from n @15:36",
        "one: fires when all of its triggers have something new: with the smallest rate, and the largest gap @36:44 | g.one.c brings 50 Hz from c, at most 21 ms apart @16:25",
        "fed: fires when all of its triggers have something new: with the smallest rate, and the largest gap @37:44 | g.fed.start is sent once and kept: it is always there @37:26 | one in 2 fires it @37:67",
        "world: fires when all of its triggers have something new: with the smallest rate, and the largest gap @38:48 | g.world.a brings 100 Hz from a, at most 10 ms apart @18:27 | how often g.world.sky brings something is not known @38:30",
        "thinned: g.thinned.a brings 100 Hz from a, at most 10 ms apart @19:29 | one in 2 fires it @39:64",
        "merged: fired by any of its triggers: rates add up, the smallest gap counts @40:50 | g.merged.a brings 100 Hz from a, at most 10 ms apart @20:28 | g.merged.b brings 40 Hz from b, at most 25 ms apart @20:38",
        "mixed: fires when all of its triggers have something new: with the smallest rate, and the largest gap @41:48 | g.mixed.merged brings 140 Hz from merged, at most 10 ms apart @21:32 | g.mixed.a brings 100 Hz from a, at most 10 ms apart @21:47",
        "q: fires when all of its triggers have something new: with the smallest rate, and the largest gap @42:40 | g.q.thinned brings 50 Hz from thinned, at most 20 ms apart @22:29 | g.q.a brings 100 Hz from a, at most 10 ms apart @22:45",
        "a takes: its own queue, on a core of its own @24:52",
        "b takes: its own queue, on a core of its own @25:52",
        "c takes: its own queue, on a core of its own @26:66",
        "d takes: its own queue, on a core of its own @27:52",
        "m takes: no execution time is written @28:3",
        "n takes: no execution time is written @29:3",
        "start takes: no execution time is written @30:30",
        "exact takes: its own queue, on a core of its own @31:69",
        "loose takes: no execution time is written @32:30",
        "late takes: its own queue, on a core of its own @33:67",
        "open takes: no execution time is written @34:28",
        "dark takes: no execution time is written @35:28",
        "one takes: no execution time is written @36:26",
        "fed takes: no execution time is written @37:26",
        "world takes: no execution time is written @38:30",
        "thinned takes: its own queue, on a core of its own @39:73",
        "merged takes: its own queue, on a core of its own @40:64",
        "mixed takes: no execution time is written @41:30",
        "q takes: no execution time is written @42:22",
    ]
    assert list_edges(analysis) == [
        "a>exact: loss 3/5, rereads 1, beat 50, queue 3",
        "a>loose: loss 1/2, rereads 1, beat 0, queue none ?loose",
        "a>late: loss 3/4, rereads 1, beat 0, queue 5",
        "a>open: loss none ?m, rereads none ?m, beat none ?m, queue none ?m,open",
        "a>world: loss none ?g.world.sky, rereads none ?g.world.sky, beat none ?g.world.sky, queue none ?g.world.sky,world",
        "a>thinned: loss 1/2, rereads 1, beat 0, queue 1",
        "a>merged: loss 0, rereads 1, beat 0, queue 1",
        "a>mixed: loss 0, rereads 1, beat 0, queue none ?mixed",
        "a>q: loss 1/2, rereads 1, beat 0, queue none ?q",
        "b>exact: loss 0, rereads 1, beat 0, queue 2",
        "b>open: loss none ?m, rereads none ?m, beat none ?m, queue none ?m,open",
        "b>merged: loss 0, rereads 1, beat 0, queue 1",
        "c>loose: loss 0, rereads 1, beat 0, queue none ?loose",
        "c>one: loss 0, rereads 1, beat 0, queue none ?one",
        "d>late: loss 0, rereads 1, beat 0, queue 2",
        "m>open: loss >= none ?m, rereads >= none ?m, beat >= none ?m, queue none ?m",
        "m>dark: loss >= none ?m,n, rereads >= none ?m,n, beat >= none ?m,n, queue none ?m",
        "n>dark: loss >= none ?n,m, rereads >= none ?n,m, beat >= none ?n,m, queue none ?n",
        "start>fed: loss 0, rereads 1, beat 0, queue 1",
        "thinned>q: loss 0, rereads 1, beat 0, queue none ?q",
        "merged>mixed: loss 2/7, rereads 1, beat 0, queue none ?mixed",
    ]


def test_conditional_outputs_and_promises() -> None:
    """What is conditional comes between never and each time. A promise counts unless what works is slower: 30 + (R - B) > 20."""
    analysis = analyse_sketch(
        {
            "never": "period: 10 ms, wcet: 2 ms, bcet: 1 ms, outputs: {out: {conditional: true}}",
            "sure": "period: 10 ms, wcet: 2 ms, bcet: 1 ms, outputs: {out: {conditional: true, max_gap: 50 ms}}",
            "vain": "period: 30 ms, wcet: 2 ms, bcet: 1 ms, outputs: {out: {conditional: true, max_gap: 20 ms}}",
            "just": "period: 30 ms, wcet: 2 ms, bcet: 1 ms, outputs: {out: {conditional: true, max_gap: 31 ms}}",
            "dark": "outputs: {out: {conditional: true, max_gap: 50 ms}}",
            "full @pc": "period: 10 ms, wcet: 10 ms, outputs: {out: {conditional: true, max_gap: 50 ms}}",
            "r1": "wcet: 1 ms",
            "r2": "wcet: 1 ms",
            "r3": "wcet: 1 ms",
            "r4": "wcet: 1 ms",
            "r5": "wcet: 1 ms",
        },
        "never>r1 sure>r2 vain>r3 dark>r4 full>r5",
        "hosts: {pc: {cores: 1}}",
    )
    assert list_paces(analysis) == [
        "never periodic written: 100 Hz, gap 10, jitter 0, apart 10",
        "sure periodic written: 100 Hz, gap 10, jitter 0, apart 10",
        "vain periodic written: 100/3 Hz, gap 30, jitter 0, apart 30",
        "just periodic written: 100/3 Hz, gap 30, jitter 0, apart 30",
        "dark None inferred: none ?dark Hz, gap none ?dark, jitter none ?dark, apart none ?dark",
        "full periodic written: 100 Hz, gap 10, jitter 0, apart 10",
        "r1 event inferred: <= 100 [conditional: between none and this] Hz, gap none [unbounded], jitter 1, apart 9",
        "r2 event inferred: <= 100 [conditional: between none and this] Hz, gap 50 [promised], jitter 1, apart 9",
        "r3 event inferred: <= 100/3 [conditional: between none and this] Hz, gap 31, jitter 1, apart 29",
        "r4 event inferred: none ?dark Hz, gap 50 [promised], jitter none ?dark, apart none ?dark",
        "r5 event inferred: <= 100 [conditional: between none and this] Hz, gap none ?full [overload], jitter none [unbounded], apart none [unbounded]",
    ]
    assert list_outputs(analysis) == [
        "never g.never.out periodic written: <= 100 [conditional: between none and this] Hz, gap none [unbounded], jitter 0, apart 0 # g.never.out is conditional @16:87",
        "sure g.sure.out periodic written: <= 100 [conditional: between none and this] Hz, gap 50 [promised], jitter 0, apart 0 # g.sure.out is conditional @17:85",
        "vain g.vain.out periodic written: <= 100/3 [conditional: between none and this] Hz, gap 31, jitter 0, apart 0 # g.vain.out is conditional @18:85",
        "just g.just.out periodic written: <= 100/3 [conditional: between none and this] Hz, gap 31 [promised], jitter 0, apart 0 # g.just.out is conditional @19:85",
        "dark g.dark.out None inferred: none ?dark Hz, gap 50 [promised], jitter none ?dark, apart 0 # g.dark.out is conditional @20:46",
        "full g.full.out periodic written: <= 100 [conditional: between none and this] Hz, gap none [overload], jitter 0, apart 0 # g.full.out is conditional @21:84",
        "r1 g.r1.out event inferred: <= 100 [conditional: between none and this] Hz, gap none [unbounded], jitter 2, apart 8",
        "r2 g.r2.out event inferred: <= 100 [conditional: between none and this] Hz, gap 51 [promised], jitter 2, apart 8",
        "r3 g.r3.out event inferred: <= 100/3 [conditional: between none and this] Hz, gap 32, jitter 2, apart 28",
        "r4 g.r4.out event inferred: none ?dark Hz, gap >= 50 ?dark [promised; assuming a dedicated core], jitter >= none ?dark [assuming a dedicated core], apart none ?",
        "r5 g.r5.out event inferred: <= 100 [conditional: between none and this] Hz, gap none ?full [overload], jitter none [unbounded; assuming a dedicated core], apart none [unbounded]",
    ]
    assert list_responses(analysis) == [
        "never 1..2 [assuming a dedicated core] dedicated",
        "sure 1..2 [assuming a dedicated core] dedicated",
        "vain 1..2 [assuming a dedicated core] dedicated",
        "just 1..2 [assuming a dedicated core] dedicated",
        "dark none ?dark..>= none ?dark unknown",
        "full none ?full..none [overload] host",
        "r1 none ?r1..1 [assuming a dedicated core] dedicated",
        "r2 none ?r2..1 [assuming a dedicated core] dedicated",
        "r3 none ?r3..1 [assuming a dedicated core] dedicated",
        "r4 none ?r4..>= 1 ?dark [assuming a dedicated core] dedicated",
        "r5 none ?r5..none [unbounded; assuming a dedicated core] dedicated",
    ]
    assert list_edges(analysis) == [
        "never>r1: loss 0, rereads 1, beat 0, queue 1",
        "sure>r2: loss 0, rereads 1, beat 0, queue 1",
        "vain>r3: loss 0, rereads 1, beat 0, queue 1",
        "dark>r4: loss 0, rereads 1, beat 0, queue none ?dark",
        "full>r5: loss 0, rereads 1, beat 0, queue none [unbounded]",
    ]


UNFED = """
groups: {g: {components: {
  a: {outputs: {out: Data}},
  start: {outputs: {out: Data}},
  one: {inputs: {a: a.out, x: {type: Data, optional: true}}},
  lone: {inputs: {x: {type: Data}}},
  every: {inputs: {a: a.out, x: {type: Data, optional: true}}},
  need: {inputs: {a: a.out, x: {type: Data}}},
  kept: {inputs: {i: [start.out, a.out]}}}}}
nodes:
  a: {implements: a, timing: {period: 10 ms, wcet: 1 ms, bcet: 1 ms}}
  start: {implements: start, timing: {behaviour: once, wcet: 1 ms}}
  one: {implements: one, timing: {behaviour: event, trigger: [a, x], wcet: 1 ms, bcet: 1 ms}}
  lone: {implements: lone, timing: {behaviour: event, trigger: [x], wcet: 1 ms}}
  every: {implements: every, timing: {behaviour: event, trigger: {all: [a, x]}, wcet: 1 ms}}
  need: {implements: need, timing: {behaviour: event, trigger: {all: [a, x]}, wcet: 1 ms}}
  kept: {implements: kept, timing: {behaviour: event, trigger: {all: [i]}, wcet: 1 ms}}
types: {Data: {message: std_msgs/msg/String, size: 1 kB}}
"""


def test_inputs_that_nothing_feeds_and_inputs_that_two_feed() -> None:
    """How often an input without a source brings something, nobody knows: that leaves any-of open, whether it is optional or not.
    All-of waits for ever, except for an optional input. What is kept from the start is renewed by the other source, which fires.
    """
    analysis = analyse_architecture(architecture(UNFED))
    assert list_paces(analysis)[2:] == [
        "one event inferred: >= 100 ?g.one.x Hz, gap 10, jitter none ?g.one.x, apart none ?g.one.x",
        "lone event inferred: none ?g.lone.x Hz, gap none ?g.lone.x, jitter none ?g.lone.x, apart none ?g.lone.x",
        "every event inferred: 100 Hz, gap 10, jitter 0, apart 10",
        "need event inferred: 0 [never fires] Hz, gap none [unbounded], jitter 0, apart none [unbounded]",
        "kept event inferred: 100 Hz, gap 10, jitter 0, apart 10",
    ]
    assert list_responses(analysis)[2:] == [
        "one 1..>= 1 ?g.one.x [assuming a dedicated core] dedicated",
        "lone none ?lone..>= 1 ?g.lone.x [assuming a dedicated core] dedicated",
        "every none ?every..1 [assuming a dedicated core] dedicated",
        "need none ?need..1 [assuming a dedicated core] dedicated",
        "kept none ?kept..1 [assuming a dedicated core] dedicated",
    ]
    assert analysis.deadlocked == (("need",),)
    # Two different sources need no topic beside their names.
    assert [reason.text for reason in analysis.paces["kept"].reasons[2:]] == [
        "g.kept.i brings 100 Hz from a, at most 10 ms apart",
        "g.kept.i brings 0 Hz from start",
    ]


def test_two_outputs_of_one_source_on_one_input_are_told_apart_by_their_topics() -> None:
    text = """
groups: {g: {components: {
  a: {outputs: {out: Data, more: Data}},
  b: {outputs: {out: Data}},
  r: {inputs: {i: [a.out, a.more, b.out]}}}}}
nodes:
  a: {implements: a, timing: {period: 10 ms, wcet: 1 ms, bcet: 1 ms}}
  b: {implements: b, timing: {period: 20 ms, wcet: 1 ms, bcet: 1 ms}}
  r: {implements: r, timing: {wcet: 1 ms}}
types: {Data: {message: std_msgs/msg/String, size: 1 kB}}
"""
    pace = analyse_architecture(architecture(text)).paces["r"]
    assert sorted(reason.text for reason in pace.reasons) == [
        "g.r.i brings 100 Hz from a on /g/a/more, at most 10 ms apart",
        "g.r.i brings 100 Hz from a on /g/a/out, at most 10 ms apart",
        "g.r.i brings 50 Hz from b on /g/b/out, at most 20 ms apart",
    ]
    assert (show(pace.rate), show_ms(pace.gap)) == ("250", "10")


def test_a_ring_that_runs_for_ever_and_one_that_dies_out() -> None:
    """Each event of `a` fires `b` and so another of `a`; of two in the other ring one is left, for how long nobody knows."""
    analysis = analyse_sketch(
        {
            "s": "period: 10 ms, wcet: 1 ms",
            "a": "wcet: 1 ms",
            "b": "wcet: 1 ms",
            "c": "every: 2, wcet: 1 ms",
            "d": "wcet: 1 ms",
        },
        "s>a b>a a>b s>c d>c c>d",
    )
    assert {name: show(pace.rate) for name, pace in analysis.paces.items()} == {
        "s": "100",
        "a": "none [unbounded]",
        "b": "none [unbounded]",
        "c": "none ?c [a ring of triggers]",
        "d": "none ?d [a ring of triggers]",
    }


def test_all_of_what_may_come_irregularly_is_an_upper_bound() -> None:
    """The slower one counts; where it is not known that both come like clockwork, they may miss each other."""
    analysis = analyse_sketch(
        {
            "fast": "period: 10 ms, wcet: 1 ms, bcet: 1 ms",
            "slow": "period: 20 ms, wcet: 1 ms, bcet: 1 ms",
            "loose": "period: 20 ms, wcet: 2 ms, bcet: 1 ms",
            "shaky": "period: 20 ms, jitter: 1 ms, wcet: 1 ms, bcet: 1 ms",
            "dark": "period: 20 ms",
            "relay": "trigger: [dark], wcet: 1 ms, bcet: 1 ms",
            "both": "trigger: {all: [fast, slow]}",
            "late": "trigger: {all: [fast, loose]}",
            "more": "trigger: {all: [fast, shaky]}",
            "open": "trigger: {all: [fast, relay]}",
            "alone": "trigger: {all: [relay]}",
        },
        "fast>both slow>both fast>late loose>late fast>more shaky>more dark>relay fast>open relay>open relay>alone",
    )
    assert {name: show(pace.rate) for name, pace in list(analysis.paces.items())[6:]} == {
        "both": "50",
        "late": "<= 50",
        "more": "<= 50",
        "open": "<= 50",
        "alone": "50",
    }


@pytest.mark.parametrize(
    ("latency", "gap"),
    [
        ("{best: 1 ms, worst: 4 ms}", "13"),  # a message that takes 1 ms, the next one 4 ms
        ("{worst: 4 ms}", "14"),
        ("3 ms", "10"),
    ],
)
def test_a_link_widens_a_gap_by_what_it_varies(latency: str, gap: str) -> None:
    hosts = f"hosts: {{p: {{cores: 1}}, q: {{cores: 1}}}}\nlinks: {{lan: {{connects: [p, q], latency: {latency}}}}}"
    nodes = {"a @p": "period: 10 ms, wcet: 1 ms, bcet: 1 ms", "r @q": "wcet: 1 ms"}
    analysis = analyse_sketch(nodes, "a>r", hosts)
    assert show_ms(analysis.paces["r"].gap) == gap
