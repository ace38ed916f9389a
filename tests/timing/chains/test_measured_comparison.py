"""Designed against measured: reading what was observed, and naming outliers."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction

import pytest

from archgen.diagnostics.source_span import NO_SPAN
from archgen.model.quantity import Quantity
from archgen.project.observation_reading import read_observations
from archgen.timing.analysis import EventPace
from archgen.timing.chains.chain_bounds import bound_all_chains
from archgen.timing.chains.measured_comparison import MeasuredComparison, Observation, compare_measured
from archgen.timing.chains.sample_statistics import SampleCounter
from archgen.timing.figures.timing_values import TimingValue
from archgen.timing.run_analysis import analyse_architecture
from archgen.timing.system.timing_system import StoringCallback
from tests.timing.made import MS, analysis, arc, event, ms, periodic
from tests.timing.sketches import read_sketch

YAML = """measured:
  cam:
    rate: 8 Hz
    wcet: 12 ms
    bcet: 4 ms
    response: 21 ms
  /cam:
    period: 104 ms
    max_period: 130 ms
    min_period: 90 ms
"""
CSV = "id,rate,wcet\ncam,9.5 Hz,\n/cam, 10 Hz,\n"


def _found(file: str, text: str) -> list[tuple[str, str, str, str]]:
    made = analysis(
        [periodic("cam", 100, wcet=10 * MS, bcet=5 * MS), periodic("det", 100)],
        [arc("cam", "det")],
        {"cam": 20, "det": 1},
        {"cam": 100, "det": 100},
    )
    pace = EventPace("periodic", TimingValue(Fraction(10)), ms(100), distance=ms(95))
    made = replace(made, paces={**made.paces, "cam": pace}, outputs={("cam", "cam.out"): replace(pace, gap=ms(120))})
    observed, problems = read_observations(file, text)
    compared, unknown = compare_measured(made, observed)
    assert not problems
    assert not unknown
    return [(row.id, row.key, row.verdict, row.why) for row in compared]


def test_outliers_are_named() -> None:
    assert _found("run.yaml", YAML) == [
        ("cam", "rate", "outlier", "slower than designed by more than 10 %"),
        ("cam", "wcet", "outlier", "takes longer than the design says"),
        ("cam", "bcet", "outlier", "is quicker than the design says: jitter grows"),
        ("cam", "response", "outlier", "the bound on the response time does not hold"),
        ("/cam", "period", "as designed", ""),
        ("/cam", "max_period", "outlier", "gaps are larger than the bounds rest on"),
        ("/cam", "min_period", "outlier", "they come closer than the bounds rest on"),
    ]


def test_csv_says_the_same() -> None:
    assert _found("run.csv", CSV) == [("cam", "rate", "as designed", ""), ("/cam", "rate", "as designed", "")]


def _problems(file: str, text: str) -> list[str]:
    made = analysis([periodic("cam", 100)], [], {"cam": 1}, {"cam": 100})
    observed, problems = read_observations(file, text)
    _, unknown = compare_measured(made, observed)
    return [f"{d.span} {d.rule}: {d.message} ({d.help})" for d in (*problems, *unknown)]


def test_what_cannot_be_read_is_said_at_its_place() -> None:
    assert _problems("a.yaml", "measured:\n  cam: {rate: 10, wect: 3 ms}\n  cap: {rate: 1 Hz}\n") == [
        "a.yaml:2:15 wrong-value: `rate` takes a frequency with its unit, such as 29.7 Hz (None)",
        "a.yaml:2:19 unknown-key: `wect` cannot be measured (did you mean `wcet`?)",
        "a.yaml:3:3 unknown-reference: no node, activity or topic is called `cap` (did you mean `cam`?)",
    ]
    assert _problems("a.yaml", "cam: 3\n") == [
        "a.yaml:1:1 missing-key: `measured`, the mapping of what was observed, is missing (write `measured: {ID: {rate: 10 Hz}}`)"
    ]
    assert _problems("a.yaml", "measured:\n  cam: 10 Hz\n") == [
        "a.yaml:2:3 wrong-value: `cam` takes a mapping of figures (None)"
    ]
    assert _problems("a.csv", "name,rate\ncam,1 Hz\n") == [
        "a.csv:1:1 missing-key: the first line does not begin with `id` (begin with `id,rate,wcet`, for instance)"
    ]
    assert _problems("a.csv", "id,rate\ncam,0 Hz\ncam,1 Hz,3\n") == [
        "a.csv:2:1 wrong-value: `rate` takes a frequency with its unit, such as 29.7 Hz (None)",
        "a.csv:3:1 wrong-value: this line has 3 cells, the first one 2 (None)",
    ]


def _verdicts(paces: dict[str, EventPace], text: str) -> list[tuple[str, str, str]]:
    """Compare what is measured on /t, which each of these outputs publishes."""
    made = analysis(
        [periodic(name, 100) for name in (*paces, "reader")],
        [replace(arc(name, "reader"), topic="/t") for name in paces],
        dict.fromkeys((*paces, "reader"), 1),
        dict.fromkeys((*paces, "reader"), 100),
    )
    made = replace(made, outputs={(name, f"{name}.out"): pace for name, pace in paces.items()})
    observed, problems = read_observations("run.yaml", f"measured: {{/t: {text}}}\n")
    assert not problems
    compared, unknown = compare_measured(made, observed)
    assert not unknown
    return [(row.key, row.verdict, row.why) for row in compared]


def test_a_topic_has_the_rates_of_all_its_publishers() -> None:
    pace = EventPace("periodic", TimingValue(Fraction(10)), ms(100), distance=ms(95))
    both = {"a": pace, "b": replace(pace, gap=ms(120))}
    assert _verdicts(both, "{rate: 20 Hz, period: 50 ms}") == [
        ("rate", "as designed", ""),
        ("period", "as designed", ""),
    ]
    assert _verdicts(both, "{rate: 10 Hz}") == [("rate", "outlier", "slower than designed by more than 10 %")]
    # Each sends within its own gap; how close the samples of two come, nobody designed.
    assert _verdicts(both, "{max_period: 101 ms, min_period: 1 ms}") == [
        ("max_period", "outlier", "gaps are larger than the bounds rest on"),
        ("min_period", "not designed", ""),
    ]


def test_what_is_sent_at_most_so_often_may_come_as_rarely_as_it_likes() -> None:
    conditional = {"a": EventPace("periodic", TimingValue(Fraction(10), side="at most"), ms(100))}
    assert _verdicts(conditional, "{rate: 2 Hz}") == [("rate", "as designed", "")]
    assert _verdicts(conditional, "{period: 500 ms}") == [("period", "as designed", "")]
    assert _verdicts(conditional, "{rate: 12 Hz}") == [("rate", "outlier", "faster than designed by more than 10 %")]
    assert _verdicts(conditional, "{period: 80 ms}") == [
        ("period", "outlier", "faster than designed by more than 10 %")
    ]


@pytest.mark.parametrize(
    ("text", "verdict", "ratio"),
    [
        # Designed are 10 Hz: up to a tenth more or less is as designed.
        ("rate: 11 Hz", "as designed", Fraction(11, 10)),
        ("rate: 11.001 Hz", "outlier", Fraction(11001, 10000)),
        ("rate: 9 Hz", "as designed", Fraction(9, 10)),
        ("rate: 8.999 Hz", "outlier", Fraction(8999, 10000)),
        ("period: 110 ms", "as designed", Fraction(11, 10)),
        ("period: 90 ms", "as designed", Fraction(9, 10)),
        ("period: 111 ms", "outlier", Fraction(111, 100)),
        ("period: 89 ms", "outlier", Fraction(89, 100)),
        # A bound holds where it is just reached.
        ("max_period: 100 ms", "as designed", 1),
        ("max_period: 101 ms", "outlier", Fraction(101, 100)),
        ("min_period: 95 ms", "as designed", 1),
        ("min_period: 94 ms", "outlier", Fraction(94, 95)),
        ("wcet: 10 ms", "as designed", 1),
        ("wcet: 11 ms", "outlier", Fraction(11, 10)),
        ("bcet: 5 ms", "as designed", 1),
        ("bcet: 4 ms", "outlier", Fraction(4, 5)),
        ("response: 20 ms", "as designed", 1),
        ("response: 21 ms", "outlier", Fraction(21, 20)),
    ],
)
def test_where_a_measured_figure_becomes_an_outlier(text: str, verdict: str, ratio: Fraction) -> None:
    (row,) = _rows("cam", text)
    assert (row.verdict, row.ratio) == (verdict, ratio)


@pytest.mark.parametrize(
    "text",
    ["rate: 1 Hz", "period: 1 s", "max_period: 1 s", "min_period: 1 s", "wcet: 1 s", "bcet: 1 s", "response: 1 s"],
)
def test_beside_what_nobody_designed_stands_no_ratio(text: str) -> None:
    (row,) = _rows("dark", text)
    assert (row.verdict, row.ratio) == ("not designed", None)


def _rows(name: str, text: str) -> tuple[MeasuredComparison, ...]:
    """Compare one figure of `cam`, of which everything is designed, or of `dark`, of which nothing is."""
    made = analysis([periodic("cam", 100, wcet=10 * MS, bcet=5 * MS), event("dark")], [], {"cam": 20}, {"cam": 100})
    pace = EventPace("periodic", TimingValue(Fraction(10)), ms(100), distance=ms(95))
    observed, problems = read_observations("run.yaml", f"measured: {{{name}: {{{text}}}}}\n")
    assert not problems
    compared, unknown = compare_measured(replace(made, paces={**made.paces, "cam": pace}), observed)
    assert not unknown
    return compared


def test_what_only_recordings_give_is_held_against_its_counterpart() -> None:
    activity = periodic("det", 100, storing={"det.cam": StoringCallback(2 * MS)}, inputs=("det.cam", "det.map"))
    made = analysis([activity], [], {"det": 1}, {"det": 100})
    observed = tuple(
        Observation(name, {key: Quantity(Fraction(value * MS), "")}, NO_SPAN)
        for name, key, value in (("det.cam", "storing", 3), ("det.map", "storing", 3), ("/cam", "delay", 3))
    )
    compared, unknown = compare_measured(made, observed)
    assert unknown == ()
    assert [(row.id, row.verdict, row.designed.value) for row in compared] == [
        ("det.cam", "outlier", 2 * MS),
        ("det.map", "not designed", None),
        ("/cam", "not designed", None),
    ]


@pytest.mark.parametrize(("inaccuracy", "verdict"), [(0, "outlier"), (1, "outlier"), (2, "as designed")])
def test_what_the_recording_cannot_tell_is_no_outlier(inaccuracy: int, verdict: str) -> None:
    made = analysis([periodic("cam", 100, wcet=10 * MS)], [], {"cam": 20}, {"cam": 100})
    wcet = {"wcet": Quantity(Fraction(12 * MS), "")}
    observed = Observation("cam", wcet, NO_SPAN, {}, {"wcet": Fraction(inaccuracy * MS)})
    assert [row.verdict for row in compare_measured(made, (observed,))[0]] == [verdict]


def test_shares_of_reactions_are_judged_by_all_that_was_recorded() -> None:
    rest = "chains: {c: {through: [a, b], deadline: {always: 1 s, 50 %: 60 ms, 95 %: 90 ms, 99.9 %: 99 ms}}}"
    model = read_sketch({"a": "period: 100 ms, wcet: 1 ms", "b": "wcet: 1 ms"}, "a>b", rest)
    found = analyse_architecture(model)
    counter = SampleCounter()
    for value in range(1, 101):
        counter.add_sample(value * MS)
    latency = {"latency": Quantity(Fraction(100 * MS), "")}
    observed = Observation("c", latency, NO_SPAN, {"latency": counter.summarise()})
    rows, _ = compare_measured(found, (observed,), bound_all_chains(found, model))
    assert [(row.key, row.measured, row.verdict, row.why) for row in rows if row.key != "latency"] == [
        ("latency of 50 %", 50 * MS, "as designed", ""),
        ("latency of 95 %", 95 * MS, "outlier", "95 % of its reactions take longer than their deadline"),
        ("latency of 99.9 %", 100 * MS, "outlier", "99.9 % of its reactions take longer than their deadline"),
    ]
