"""Chains, step by step, and the reasoning behind each figure with its place in the files."""

from __future__ import annotations

from tests.timing.sketches import analyse_sketch, explain, list_chains, read_sketch

EVERY_KIND_OF_STEP = (
    {
        "cam @p": "period: 40 ms, jitter: 2 ms, wcet: 3 ms, bcet: 1 ms",
        "imu @p": "period: 10 ms, wcet: 1 ms, bcet: 1 ms",
        "thin @q": "trigger: [cam], every: 3, jitter: 5 ms, wcet: 2 ms, bcet: 1 ms",
        "all2 @q": "trigger: {all: [thin, imu]}, wcet: 2 ms",
        "poll @q": "period: 25 ms, wcet: 1 ms",
        "slow @q": "trigger: [imu], throttle: 30 ms, wcet: 1 ms",
        "late @q": "trigger: [imu], jitter: 4 ms, wcet: 1 ms",
        "said @q": "trigger: [poll], response: 6 ms, wcet: 1 ms",
        "once @q": "behaviour: once, wcet: 1 ms",
        "dark": "",
        "cond @q": "trigger: [imu], wcet: 1 ms, outputs: {out: {conditional: true}}",
        "prom @q": "trigger: [imu], wcet: 1 ms, outputs: {out: {conditional: true, max_gap: 70 ms}}",
        "end @q": "trigger: [cond], wcet: 1 ms",
        "end2 @q": "trigger: [prom], wcet: 1 ms",
        "server @q": "wcet: 4 ms, bcet: 2 ms",
        "asker @p": "period: 50 ms, wcet: 1 ms, bcet: 1 ms, calls: {server: 0.5}",
        "hub @q": "wcet: 1 ms",
    },
    "cam>thin thin>all2 imu>all2 all2>poll imu>slow imu>late poll>said said>once said>dark imu>cond cond>end imu>prom prom>end2 asker?server late>hub slow>hub imu>poll",
    (
        "hosts: {p: {cores: 1}, q: {cores: 16}}\n"
        "links: {lan: {connects: [p, q], latency: {best: 1 ms, worst: 3 ms}}, fast: {connects: [p, q], bandwidth: 80 Mbit/s, latency: {best: 1 ms}}}\n"
        "chains:\n"
        "  main: {through: [cam, thin, all2, poll, said], deadline: 300 ms}\n"
        "  throttled: {through: [imu, slow], deadline: 20 ms}\n"
        "  jittery: {through: [late, hub], deadline: 1 s}\n"
        "  world: {through: [slow, hub]}\n"
        "  once: {through: [said, once], deadline: 1 s}\n"
        "  dark: {through: [said, dark]}\n"
        "  from_dark: {through: [dark, cam]}\n"
        "  from_once: {through: [once]}\n"
        "  cond: {through: [cond, end]}\n"
        "  prom: {through: [imu, prom, end2]}\n"
        "  call: {through: [asker, server]}\n"
        "  answer: {through: [server, asker]}\n"
        "  ways: {through: [imu, hub], deadline: 55 ms}\n"
        "  thinned: {through: [thin, all2]}\n"
    ),
)


def test_every_kind_of_step() -> None:
    """Each term by the table of docs/timing.md: `cam` samples the world, 40; `thin` waits two gaps of 42 and its jitter; `all2` the
    gap of the other trigger; `poll` its own gap; `slow` a throttle of 30 and a gap, less the smallest one.
    """
    model = read_sketch(*EVERY_KIND_OF_STEP)
    assert list_chains(analyse_sketch(*EVERY_KIND_OF_STEP), model) == [
        "main cam > thin > all2 > poll > said: 203 [the response of said is as declared], best >= 3 ?all2,poll,said, from a sample 161 [the response of said is as declared], age 192 [the response of said is as declared]: met",
        "  cam 0 + 42 + 5: samples the world every 42 ms at the latest @22:52",
        "  thin 3 + 101 + 2: triggered by /g/cam/out; fires only once for 3 triggers, starts late by its jitter @24:55",
        "  all2 0 + 16 + 2: triggered by /g/thin/out, waits for its other triggers @25:55",
        "  poll 0 + 25 + 1: reads /g/all2/out every 25 ms at the latest @26:54",
        "  said 0 + 0 + 6 [the response of said is as declared]: triggered by /g/poll/out @29:55",
        "throttled imu > slow: 61, best >= 2 ?slow, from a sample 51, age 9: not proven",
        "  imu 0 + 10 + 5: samples the world every 10 ms at the latest @23:52",
        "  slow 3 + 42 + 1: triggered by /g/imu/out; keeps a smallest gap @27:55",
        "jittery late > hub: 9 [the reaction counts from the event that fires late; data age is larger by its largest gap (20 ms)], best >= none ?late,hub, from a sample 5, age 27: met",
        "  late 0 + 4 + 2: its event is the stimulus; starts late by its jitter @28:37",
        "  hub 0 + 0 + 3: triggered by /g/late/out @38:35",
        "world slow > hub: 46 [the reaction counts from the event that fires slow; data age is larger by its largest gap (46 ms)], best >= none ?slow,hub, from a sample 4, age 51: open",
        "  slow 0 + 42 + 1: its event is the stimulus; keeps a smallest gap @27:37",
        "  hub 0 + 0 + 3: triggered by /g/slow/out @38:35",
        "once said > once: none [the response of said is as declared; unbounded; the reaction counts from the event that fires said; data age is larger by its largest gap (26 ms)], best >= none ?said,once, from a sample none [the response of said is as declared; unbounded], age 39 [the response of said is as declared]: missed",
        "  said 0 + 0 + 6 [the response of said is as declared]: its event is the stimulus @29:37",
        "  once 0 + none [unbounded] + 1: works once, at the start: nothing later reaches it @30:57",
        "dark said > dark: >= 6 ?dark,said [the response of said is as declared; the reaction counts from the event that fires said; data age is larger by its largest gap (26 ms)], best >= none ?said,dark, from a sample >= 6 ?dark,said [the response of said is as declared], age >= 6 ?dark,said [the response of said is as declared]: open",
        "  said 0 + 0 + 6 [the response of said is as declared]: its event is the stimulus @29:37",
        "  dark none ?dark + 0 + >= none ?dark,said: triggered by /g/said/out @31:3",
        "from_dark dark > cam: none ? [no way leads from `dark` to `cam`], best none ? [no way leads from `dark` to `cam`], from a sample none ? [no way leads from `dark` to `cam`], age none ? [no way leads from `dark` to `cam`]: open",
        "from_once once: none [unbounded], best >= none ?once, from a sample 1, age 1: open",
        "  once 0 + none [unbounded] + 1: works once, at the start: nothing later reaches it @30:57",
        "cond cond > end: 2 [cond publishes /g/cond/out for this very input; the reaction counts from the event that fires cond; data age is larger by its largest gap (16 ms)], best >= none ?cond,end, from a sample 2 [cond publishes /g/cond/out for this very input], age 2: open",
        "  cond 0 + 0 + 1: its event is the stimulus @32:37",
        "  end 0 + 0 [cond publishes /g/cond/out for this very input] + 1: triggered by /g/cond/out @34:53",
        "prom imu > prom > end2: 90, best >= 2 ?prom,end2, from a sample 80, age 10: open",
        "  imu 0 + 10 + 5: samples the world every 10 ms at the latest @23:52",
        "  prom 3 + 0 + 1: triggered by /g/imu/out @33:55",
        "  end2 0 + 70 + 1: triggered by /g/prom/out @35:55",
        "call asker > server: 62 [asker calls /g/server/serve in this very activation], best 4, from a sample 12 [asker calls /g/server/serve in this very activation], age 12: open",
        "  asker 0 + 50 + 5: samples the world every 50 ms at the latest @37:56",
        "  server 3 + 0 [asker calls /g/server/serve in this very activation] + 4: called by /g/server/serve @19:32",
        "answer server > asker: 66 [the reaction counts from the event that fires server; data age is larger by its largest gap (unknown for server)], best 4, from a sample 66, age >= 16 ?server: open",
        "  server 0 + 0 + 4: its event is the stimulus @36:41",
        "  asker 3 + 54 + 5: takes the answer of /g/server/serve every 50 ms at the latest, which may wait 4 ms to be stored @37:56",
        "ways imu > slow > hub: 64, best >= 2 ?slow,hub, from a sample 54, age 59: not proven",
        "  imu 0 + 10 + 5: samples the world every 10 ms at the latest @23:52",
        "  slow 3 + 42 + 1: triggered by /g/imu/out; keeps a smallest gap @27:55",
        "  hub 0 + 0 + 3: triggered by /g/slow/out @38:35",
        "thinned thin > all2: 121 [the reaction counts from the event that fires thin; data age is larger by its largest gap (149 ms)], best >= 1 ?all2, from a sample 20, age 20: open",
        "  thin 0 + 101 + 2: its event is the stimulus; fires only once for 3 triggers, starts late by its jitter @24:37",
        "  all2 0 + 16 + 2: triggered by /g/thin/out, waits for its other triggers @25:55",
    ]


def test_why_every_kind_of_step() -> None:
    model, analysis = read_sketch(*EVERY_KIND_OF_STEP), analyse_sketch(*EVERY_KIND_OF_STEP)
    assert explain(analysis, model, "main") == [
        "main: 203 ms, the sum of all that follows: what each step waits and takes, and links @0:0",
        "  cam waits 42 ms: samples the world every 42 ms at the latest @22:52",
        "    gap 40 ms + 2 ms = 42 ms: period and jitter @0:0",
        "  cam takes 5 ms at most @0:0",
        "  link to thin: 3 ms @0:0",
        "  thin waits 101 ms: triggered by /g/cam/out; fires only once for 3 triggers, starts late by its jitter @24:55",
        "    gap 42 ms + (5 ms - 1 ms) + (3 ms - 1 ms) = 48 ms: the largest gap of cam, its response less its best case (R - B), what lan adds @0:0",
        "    waits 2 x 48 ms + 5 ms = 101 ms: up to 2 more triggers, 48 ms apart at most; jitter 5 ms @0:0",
        "  thin takes 2 ms at most @0:0",
        "  all2 waits 16 ms: triggered by /g/thin/out, waits for its other triggers @25:55",
        "    gap 10 ms + (5 ms - 1 ms) + (3 ms - 1 ms) = 16 ms: the largest gap of imu, its response less its best case (R - B), what lan adds @0:0",
        "    gap 149 ms + (2 ms - 1 ms) = 150 ms: the largest gap of thin, its response less its best case (R - B) @0:0",
        "  all2 takes 2 ms at most @0:0",
        "  poll waits 25 ms: reads /g/all2/out every 25 ms at the latest @26:54",
        "  poll takes 1 ms at most @0:0",
        "  said waits 0 ms: triggered by /g/poll/out @29:55",
        "  said takes 6 ms at most @0:0",
        "  42 ms + 5 ms + 3 ms + 101 ms + 2 ms + 16 ms + 2 ms + 25 ms + 1 ms + 6 ms = 203 ms @0:0",
        "  why an element takes so long: --why ELEMENT @0:0",
        "  assumes: the response of said is as declared @0:0",
    ]
    assert explain(analysis, model, "throttled") == [
        "throttled: 61 ms, the sum of all that follows: what each step waits and takes, and links @0:0",
        "  imu waits 10 ms: samples the world every 10 ms at the latest @23:52",
        "  imu takes 5 ms at most @0:0",
        "  link to slow: 3 ms @0:0",
        "  slow waits 42 ms: triggered by /g/imu/out; keeps a smallest gap @27:55",
        "    gap 10 ms + (5 ms - 1 ms) + (3 ms - 1 ms) = 16 ms: the largest gap of imu, its response less its best case (R - B), what lan adds @0:0",
        "    waits 16 ms + 30 ms - 4 ms = 42 ms: up to 1 more trigger, 16 ms apart at most; throttle 30 ms; what waits came 4 ms after the last firing at least @0:0",
        "  slow takes 1 ms at most @0:0",
        "  10 ms + 5 ms + 3 ms + 42 ms + 1 ms = 61 ms @0:0",
        "  why an element takes so long: --why ELEMENT @0:0",
    ]
    assert explain(analysis, model, "all2") == [
        "all2: event (inferred), rate <= ~8.333 Hz, largest gap 150 ms @25:37",
        "  fires when all of its triggers have something new: with the smallest rate, and the largest gap @25:55",
        "  g.all2.thin brings ~8.333 Hz from thin, at most 150 ms apart @7:29",
        "  g.all2.imu brings 100 Hz from imu, at most 16 ms apart @7:44",
        "  gap 10 ms + (5 ms - 1 ms) + (3 ms - 1 ms) = 16 ms: the largest gap of imu, its response less its best case (R - B), what lan adds @0:0",
        "  gap 149 ms + (2 ms - 1 ms) = 150 ms: the largest gap of thin, its response less its best case (R - B) @0:0",
        "  gap max(16 ms, 150 ms) = 150 ms: the largest counts @0:0",
        "all2: response between unknown (all2) and 2 ms (cores) @0:0",
        "  its own work: q has no more threads than cores @25:81",
        "  the least t > 0 in which all of this is done is 2 ms; of each ceil((t + how much later it may come) / how often): @0:0",
        "    1 x 2 ms all2 = 2 ms, since ceil(2 ms / 4 ms) = 1 @0:0",
        "  late (5 ms - 1 ms) + (3 ms - 1 ms) = 6 ms: so much later than regularly events from imu may come @0:0",
        "  late 13 ms + (2 ms - 1 ms) = 14 ms: so much later than regularly events from thin may come @0:0",
        "  imu: periodic, rate 100 Hz, largest gap 10 ms @23:35",
        "    every 10 ms, as written @23:52",
        "  thin: event (inferred), rate ~8.333 Hz, largest gap 149 ms @24:37",
        "    g.thin.cam brings 25 Hz from cam, at most 48 ms apart @6:28",
        "    one in 3 fires it @24:69",
        "    gap 42 ms + (5 ms - 1 ms) + (3 ms - 1 ms) = 48 ms: the largest gap of cam, its response less its best case (R - B), what lan adds @0:0",
        "    gap 3 x 48 ms + 5 ms = 149 ms: one in 3 fires it; jitter 5 ms @0:0",
        "    cam: periodic, rate 25 Hz, largest gap 42 ms @22:35",
        "      every 40 ms, up to 2 ms later, as written @22:52",
        "      gap 40 ms + 2 ms = 42 ms: period and jitter @0:0",
    ]
    assert explain(analysis, model, "hub") == [
        "hub: event (inferred), rate ~133.333 Hz, largest gap 22 ms @38:35",
        "  fired by any of its triggers: rates add up, the smallest gap counts @38:35",
        "  g.hub.late brings 100 Hz from late, at most 22 ms apart @20:28",
        "  g.hub.slow brings ~33.333 Hz from slow, at most 47 ms apart @20:44",
        "  gap 46 ms + (1 ms - 0 ms) = 47 ms: the largest gap of slow, its response less its best case (R - B) @0:0",
        "  gap 20 ms + (2 ms - 0 ms) = 22 ms: the largest gap of late, its response less its best case (R - B) @0:0",
        "  gap min(47 ms, 22 ms) = 22 ms: the smallest counts @0:0",
        "hub: response between unknown (hub) and 3 ms (cores) @0:0",
        "  its own work: q has no more threads than cores @38:50",
        "  the least t > 0 in which all of this is done is 3 ms; of each ceil((t + how much later it may come) / how often): @0:0",
        "    3 x 1 ms hub = 3 ms, since ceil((3 ms + 12 ms) / 10 ms) + ceil((3 ms + 7 ms) / 30 ms) = 3 @0:0",
        "  late 6 ms + 1 ms = 7 ms: so much later than regularly events from slow may come @0:0",
        "  late 10 ms + 2 ms = 12 ms: so much later than regularly events from late may come @0:0",
        "  slow: event (inferred), rate ~33.333 Hz, largest gap 46 ms @27:37",
        "    g.slow.imu brings 100 Hz from imu, at most 16 ms apart @9:28",
        "    throttled: at least 30 ms apart @27:72",
        "    gap 10 ms + (5 ms - 1 ms) + (3 ms - 1 ms) = 16 ms: the largest gap of imu, its response less its best case (R - B), what lan adds @0:0",
        "    gap 16 ms + 30 ms = 46 ms: throttle 30 ms @0:0",
        "    imu: periodic, rate 100 Hz, largest gap 10 ms @23:35",
        "      every 10 ms, as written @23:52",
        "  late: event (inferred), rate 100 Hz, largest gap 20 ms @28:37",
        "    g.late.imu brings 100 Hz from imu, at most 16 ms apart @10:28",
        "    gap 10 ms + (5 ms - 1 ms) + (3 ms - 1 ms) = 16 ms: the largest gap of imu, its response less its best case (R - B), what lan adds @0:0",
        "    gap 16 ms + 4 ms = 20 ms: jitter 4 ms @0:0",
        "    imu: see above @0:0",
    ]
    assert explain(analysis, model, "server") == [
        "server: on_demand (inferred), rate 10 Hz, largest gap unknown (server) @36:41",
        "  called by asker, 0.5 times for each activation: 10 Hz @37:94",
        "server: response between 2 ms and 4 ms (cores) @0:0",
        "  its own work: q has no more threads than cores @36:56",
        "  the least t > 0 in which all of this is done is 4 ms: @0:0",
        "    1 x 4 ms server = 4 ms, its own @0:0",
        "  asker: periodic, rate 20 Hz, largest gap 50 ms @37:39",
        "    every 50 ms, as written @37:56",
    ]
    assert explain(analysis, model, "p") == [
        "p: load 19.5 % of 1 core: schedulable @0:0",
        "  cam adds 25 Hz x 3 ms = 7.5 % @22:35",
        "  imu adds 100 Hz x 1 ms = 10 % @23:35",
        "  asker adds 20 Hz x 1 ms = 2 % @37:39",
    ]
    assert explain(analysis, model, "q") == [
        "q: load <= 82 % of 16 cores: schedulable @0:0",
        "  thin adds ~8.333 Hz x 2 ms = 1.7 % @24:37",
        "  all2 adds at most ~8.333 Hz x 2 ms = 1.7 % @25:37",
        "  poll adds 40 Hz x 1 ms = 4 % @26:37",
        "  slow adds ~33.333 Hz x 1 ms = 3.3 % @27:37",
        "  late adds 100 Hz x 1 ms = 10 % @28:37",
        "  said adds 40 Hz x 1 ms = 4 % @29:37",
        "  once adds 0 % @30:37",
        "  cond adds 100 Hz x 1 ms = 10 % @32:37",
        "  prom adds 100 Hz x 1 ms = 10 % @33:37",
        "  end adds at most 100 Hz x 1 ms = 10 % @34:35",
        "  end2 adds at most 100 Hz x 1 ms = 10 % @35:37",
        "  server adds 10 Hz x 4 ms = 4 % @36:41",
        "  hub adds ~133.333 Hz x 1 ms = 13.3 % @38:35",
        "  82 % / 16 cores = <= 5.1 % of all cores @0:0",
    ]
    assert explain(analysis, model, "lan") == [
        "lan: 635 kB/s, unknown (lan) of the bandwidth @0:0",
        "  /g/cam/out adds 25 Hz x 1 kB = 25 kB/s @0:0",
        "  /g/imu/out adds 6 x 100 Hz x 1 kB = 600 kB/s @0:0",
        "  /g/server/serve adds 2 x 10 Hz x 500 B = 10 kB/s @0:0",
        "lan: queueing of unknown (lan) at most; bursts of up to >= 8 kB @0:0",
    ]
    assert explain(analysis, model, "fast") == [
        "fast: 0 B/s, 0 % of the bandwidth @0:0",
        "  0 B/s / 10 MB/s = 0 % @0:0",
        "fast: queueing of 0 ms at most; bursts of up to 0 B @0:0",
    ]
    assert explain(analysis, model, "/g/cam/out") == [
        "/g/cam/out: 25 kB/s published, 25 kB/s delivered, each message 1 kB @0:0",
        "  cam publishes at 25 Hz, largest gap 46 ms @0:0",
        "    25 Hz x 1 kB = 25 kB/s @0:0",
        "    every 40 ms, up to 2 ms later, as written @22:52",
    ]
    assert explain(analysis, model, "/g/cond/out") == [
        "/g/cond/out: <= 100 kB/s published, <= 100 kB/s delivered, each message 1 kB @0:0",
        "  cond publishes at <= 100 Hz, largest gap unbounded @0:0",
        "    100 Hz x 1 kB = 100 kB/s @0:0",
        "    g.cond.out is conditional @32:83",
        "    g.cond.imu brings 100 Hz from imu, at most 16 ms apart @14:28",
    ]
    assert explain(analysis, model, "cond") == [
        "cond: 2 ms, the sum of all that follows: what each step waits and takes, and links @0:0",
        "  cond waits 0 ms: its event is the stimulus @32:37",
        "  cond takes 1 ms at most @0:0",
        "  end waits 0 ms: triggered by /g/cond/out @34:53",
        "  end takes 1 ms at most @0:0",
        "  1 ms + 1 ms = 2 ms @0:0",
        "  why an element takes so long: --why ELEMENT @0:0",
        "  assumes: cond publishes /g/cond/out for this very input @0:0",
        "  assumes: the reaction counts from the event that fires cond; data age is larger by its largest gap (16 ms) @0:0",
    ]
    assert explain(analysis, model, "once") == [
        "once: unbounded, the sum of all that follows: what each step waits and takes, and links @0:0",
        "  said waits 0 ms: its event is the stimulus @29:37",
        "  said takes 6 ms at most @0:0",
        "  once waits unbounded: works once, at the start: nothing later reaches it @30:57",
        "  once takes 1 ms at most @0:0",
        "  why an element takes so long: --why ELEMENT @0:0",
        "  assumes: the response of said is as declared @0:0",
        "  assumes: the reaction counts from the event that fires said; data age is larger by its largest gap (26 ms) @0:0",
    ]
    assert explain(analysis, model, "dark") == [
        "dark: >= 6 ms, the sum of all that follows: what each step waits and takes, and links @0:0",
        "  said waits 0 ms: its event is the stimulus @29:37",
        "  said takes 6 ms at most @0:0",
        "  link to dark: unknown (dark) @0:0",
        "  dark waits 0 ms: triggered by /g/said/out @31:3",
        "  dark takes a time that is not bounded: unknown (dark, said) @0:0",
        "  why an element takes so long: --why ELEMENT @0:0",
        "  assumes: the response of said is as declared @0:0",
        "  assumes: the reaction counts from the event that fires said; data age is larger by its largest gap (26 ms) @0:0",
    ]
    assert explain(analysis, model, "nobody") == []


LINKS_HOSTS_AND_DECLARED_RESPONSES = (
    {
        "a @p": "period: 10 ms, wcet: 1 ms, bcet: 1 ms, priority: 3",
        "b @p": "period: 20 ms, wcet: 2 ms, bcet: 2 ms, priority: 2",
        "c @q": "period: 40 ms, wcet: 5 ms",
        "d @r": "period: 40 ms, wcet: 5 ms",
        "e": "period: 40 ms, wcet: 5 ms",
        "f": "period: 10 ms",
        "hot @s": "period: 10 ms, wcet: 11 ms",
        "g @s": "wcet: 1 ms",
    },
    "a>b b>a b>c c>d d>e e>f f>a a>e hot>g",
    (
        "hosts: {p: {cores: 1}, q: {cores: 1}, r: {cores: 1}, s: {cores: 1}}\n"
        "links: {lan: {connects: [p, q], bandwidth: 8 Mbit/s, latency: {best: 1 ms, worst: 2 ms}}, wan: {connects: [q, r], bandwidth: 800 kbit/s, latency: 2 ms}}\n"
        "chains:\n"
        "  two: {through: [a, b], deadline: 23 ms}\n"
        "  far: {through: [a, b, c, d], deadline: 100 ms}\n"
        "  gap: {through: [d, e], deadline: 40 ms}\n"
        "  lost: {through: [e, f], deadline: 500 ms}\n"
        "  hot: {through: [hot, g], deadline: 1 s}\n"
        "  nowhere: {through: [g, a]}\n"
    ),
)


def test_links_hosts_and_declared_responses() -> None:
    """On one host with priorities; a link with traffic of its own; what is missing is named."""
    model = read_sketch(*LINKS_HOSTS_AND_DECLARED_RESPONSES)
    assert list_chains(analyse_sketch(*LINKS_HOSTS_AND_DECLARED_RESPONSES), model) == [
        "two a > b: 35, best 3, from a sample 25, age 15: not proven",
        "  a 0 + 10 + 1: samples the world every 10 ms at the latest @13:48",
        "  b 0 + 21 + 3: reads /g/a/out every 20 ms at the latest, which may wait 1 ms to be stored @14:48",
        "far a > b > c > d: 129 [queueing on link lan (up to 1 ms) is within its latency; link wan keeps its written latency, though 10 ms of traffic can wait for it], best >= 6 ?c,d, from a sample 119 [queueing on link lan (up to 1 ms) is within its latency; link wan keeps its written latency, though 10 ms of traffic can wait for it], age 95 [queueing on link lan (up to 1 ms) is within its latency; link wan keeps its written latency, though 10 ms of traffic can wait for it]: not proven",
        "  a 0 + 10 + 1: samples the world every 10 ms at the latest @13:48",
        "  b 0 + 21 + 3: reads /g/a/out every 20 ms at the latest, which may wait 1 ms to be stored @14:48",
        "  c 2 [queueing on link lan (up to 1 ms) is within its latency] + 40 + 5: reads /g/b/out every 40 ms at the latest @15:48",
        "  d 2 [link wan keeps its written latency, though 10 ms of traffic can wait for it] + 40 + 5: reads /g/c/out every 40 ms at the latest @16:48",
        "gap d > e: >= 90 ?e [assuming a dedicated core], best >= none ?d,e, from a sample >= 50 ?e [assuming a dedicated core], age >= 55 ?e [assuming a dedicated core]: not proven",
        "  d 0 + 40 + 5: samples the world every 40 ms at the latest @16:48",
        "  e none ?e + 40 + 5 [assuming a dedicated core]: reads /g/d/out every 40 ms at the latest @17:39",
        "lost e > f: >= 55 ?f [assuming a dedicated core], best >= none ?e,f, from a sample >= 15 ?f [assuming a dedicated core], age >= 50 ?f [assuming a dedicated core]: open",
        "  e 0 + 40 + 5 [assuming a dedicated core]: samples the world every 40 ms at the latest @17:39",
        "  f 0 + 10 + >= none ?f: reads /g/e/out every 10 ms at the latest @18:39",
        "hot hot > g: none [overload], best >= none ?hot,g, from a sample none [overload], age none [overload]: missed",
        "  hot 0 + 10 + none [overload]: samples the world every 10 ms at the latest @19:52",
        "  g 0 + 0 + none [overload]: triggered by /g/hot/out @20:31",
        "nowhere g > a: none ? [no way leads from `g` to `a`], best none ? [no way leads from `g` to `a`], from a sample none ? [no way leads from `g` to `a`], age none ? [no way leads from `g` to `a`]: open",
    ]


def test_why_links_hosts_and_declared_responses() -> None:
    model, analysis = (
        read_sketch(*LINKS_HOSTS_AND_DECLARED_RESPONSES),
        analyse_sketch(*LINKS_HOSTS_AND_DECLARED_RESPONSES),
    )
    assert explain(analysis, model, "two") == [
        "two: 35 ms, the sum of all that follows: what each step waits and takes, and links @0:0",
        "  a waits 10 ms: samples the world every 10 ms at the latest @13:48",
        "  a takes 1 ms at most @0:0",
        "  b waits 21 ms: reads /g/a/out every 20 ms at the latest, which may wait 1 ms to be stored @14:48",
        "    waits 20 ms + 1 ms = 21 ms: until it is activated, and until what it reads is stored @0:0",
        "  b takes 3 ms at most @0:0",
        "  10 ms + 1 ms + 21 ms + 3 ms = 35 ms @0:0",
        "  why an element takes so long: --why ELEMENT @0:0",
    ]
    assert explain(analysis, model, "far") == [
        "far: 129 ms, the sum of all that follows: what each step waits and takes, and links @0:0",
        "  a waits 10 ms: samples the world every 10 ms at the latest @13:48",
        "  a takes 1 ms at most @0:0",
        "  b waits 21 ms: reads /g/a/out every 20 ms at the latest, which may wait 1 ms to be stored @14:48",
        "    waits 20 ms + 1 ms = 21 ms: until it is activated, and until what it reads is stored @0:0",
        "  b takes 3 ms at most @0:0",
        "  link to c: 2 ms @0:0",
        "  c waits 40 ms: reads /g/b/out every 40 ms at the latest @15:48",
        "  c takes 5 ms at most @0:0",
        "  link to d: 2 ms @0:0",
        "  d waits 40 ms: reads /g/c/out every 40 ms at the latest @16:48",
        "  d takes 5 ms at most @0:0",
        "  10 ms + 1 ms + 21 ms + 3 ms + 2 ms + 40 ms + 5 ms + 2 ms + 40 ms + 5 ms = 129 ms @0:0",
        "  why an element takes so long: --why ELEMENT @0:0",
        "  assumes: queueing on link lan (up to 1 ms) is within its latency @0:0",
        "  assumes: link wan keeps its written latency, though 10 ms of traffic can wait for it @0:0",
    ]
    assert explain(analysis, model, "hot") == [
        "hot: overload, the sum of all that follows: what each step waits and takes, and links @0:0",
        "  hot waits 10 ms: samples the world every 10 ms at the latest @19:52",
        "  hot takes a time that is not bounded: overload @0:0",
        "  g waits 0 ms: triggered by /g/hot/out @20:31",
        "  g takes a time that is not bounded: overload @0:0",
    ]
    assert explain(analysis, model, "wan") == [
        "wan: 25 kB/s, 25 % of the bandwidth @0:0",
        "  25 kB/s / 100 kB/s = 25 % @0:0",
        "  /g/c/out adds 25 Hz x 1 kB = 25 kB/s @0:0",
        "wan: queueing of 10 ms at most; bursts of up to 1 kB @0:0",
        "  the least t > 0 in which all is sent that comes in t, at 100 kB/s, is 10 ms: @0:0",
        "    1 x 10 ms /g/c/out[1 kB] = 10 ms, since ceil((10 ms + 5 ms) / 40 ms) = 1 @0:0",
        "  1 kB / 100 kB/s = 10 ms for the largest burst alone, all that comes at once: @0:0",
        "    1 x 1 kB /g/c/out = 1 kB @0:0",
    ]
    assert explain(analysis, model, "lan") == [
        "lan: 50 kB/s, 5 % of the bandwidth @0:0",
        "  50 kB/s / 1 MB/s = 5 % @0:0",
        "  /g/b/out adds 50 Hz x 1 kB = 50 kB/s @0:0",
        "lan: queueing of 1 ms at most; bursts of up to 1 kB @0:0",
        "  the least t > 0 in which all is sent that comes in t, at 1 MB/s, is 1 ms: @0:0",
        "    1 x 1 ms /g/b/out[1 kB] = 1 ms, since ceil((1 ms + 1 ms) / 20 ms) = 1 @0:0",
        "  1 kB / 1 MB/s = 1 ms for the largest burst alone, all that comes at once: @0:0",
        "    1 x 1 kB /g/b/out = 1 kB @0:0",
    ]
    assert explain(analysis, model, "s") == [
        "s: load 120 % of 1 core: overload @0:0",
        "  hot adds 100 Hz x 11 ms = 110 % @19:35",
        "  g adds 100 Hz x 1 ms = 10 % @20:31",
    ]
    assert explain(analysis, model, "a") == [
        "a: periodic, rate 100 Hz, largest gap 10 ms @13:31",
        "  every 10 ms, as written @13:48",
        "a: response between 1 ms and 1 ms (priorities) @0:0",
        "  everything of its priority or a higher one on p, over all activations of the busy period @13:61",
        "  the least t > 0 in which all of this is done is 1 ms: @0:0",
        "    1 x 1 ms a = 1 ms, its own @0:0",
    ]
