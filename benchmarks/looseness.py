"""How far the bounds of timing are above what simulations see: a table by style of system, and the loosest cases.

Usage: python benchmarks/looseness.py [FIRST LAST [RUNS]], systems 0 to 104 and 16 runs of each where nothing is said. The
runs have random phases, everything released at once, and each activity's neighbours favoured in turn. What is seen is at most
what can happen: the true ratio may be smaller than the one that is printed, and is never larger.
What each refinement of the bounds adds to that is measured by refinements.py.
"""

from __future__ import annotations

import statistics
import sys
from collections import defaultdict
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

_ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(_ROOT))

from archgen.simulation import simulate_system  # noqa: E402 - the checkout is what is measured
from archgen.simulation.chain_witnesses import find_publish_pauses  # noqa: E402
from archgen.timing.chains.chain_bounds import bound_all_chains  # noqa: E402
from archgen.timing.figures.figure_wording import format_duration  # noqa: E402
from archgen.timing.run_analysis import analyse_architecture  # noqa: E402
from tests.timing.exceeded import bounded  # noqa: E402
from tests.timing.random_styles import STYLES, random_style_text  # noqa: E402
from tests.timing.random_systems import architecture, random_text  # noqa: E402

_SECONDS = 2
_SHOWN = 10


class HeldBound(NamedTuple):
    """A bound and the longest that was seen (ns), of a response (its tier) or a chain (empty)."""

    style: str
    seed: int
    name: str
    tier: str
    bound: float
    seen: float

    @property
    def ratio(self) -> float:
        """Return by what factor the bound is above what was seen."""
        return self.bound / self.seen


def hold_bounds(first: int, last: int, runs: int) -> Iterator[HeldBound]:
    """Yield the bounds of the systems of some seeds: one of a style, and every third one of elements of all kinds."""
    for seed in range(first, last):
        yield from _hold_system(STYLES[seed % len(STYLES)], seed, random_style_text(seed), runs)
        if seed % 3 == 0:
            yield from _hold_system("several hosts", seed, random_text(seed), runs)


def _hold_system(style: str, seed: int, text: str, runs: int) -> Iterator[HeldBound]:
    model = architecture(text)
    analysis = analyse_architecture(model)
    chains = bound_all_chains(analysis, model)
    ways = {key: chain.through for key, chain in chains.items()}
    seen = simulate_system(analysis.system, _SECONDS, runs, ways, find_publish_pauses(analysis))
    for name, activity in seen.activities.items():
        response = analysis.responses[name]
        bound = bounded(response.worst)
        if bound is not None and activity.worst_response and response.tier != "declared":
            yield HeldBound(style, seed, name, response.tier, float(bound), float(activity.worst_response))
    for key, chain in seen.chains.items():
        bound, reaction = bounded(chains[key].bound), chain.bounded_figures.reaction
        if bound is not None and reaction is not None:
            yield HeldBound(style, seed, " > ".join(chain.through), "", float(bound), float(reaction.largest))


def print_tables(held_bounds: list[HeldBound]) -> None:
    """Print both tables as Markdown."""
    by_style: dict[str, list[HeldBound]] = defaultdict(list)
    for held in held_bounds:
        by_style[held.style].append(held)
    print("| style | responses | median | 95 % | largest | chains | median | 95 % | largest |")
    print("|---|---|---|---|---|---|---|---|---|")
    for style, group in by_style.items():
        cells = [
            cell
            for is_response in (True, False)
            for cell in _describe_ratios([held.ratio for held in group if bool(held.tier) == is_response])
        ]
        print(f"| {style} | {' | '.join(cells)} |")
    one_core = {"executor", "several hosts", "ranked core", "free core"}
    responses = [held for held in held_bounds if held.tier]
    _print_loosest("on one core each", [held for held in responses if held.style in one_core])
    _print_loosest("of several cores", [held for held in responses if held.style not in one_core])
    exceeded = [held for held in held_bounds if held.bound < held.seen]
    print(f"\n{len(held_bounds)} bounds, {len(exceeded)} exceeded{''.join(f': {held}' for held in exceeded)}")


def _print_loosest(kind: str, responses: list[HeldBound]) -> None:
    print(f"\n| loosest, {kind} | system | element | tier | bound | seen | ratio |\n|---|---|---|---|---|---|---|")
    for held in sorted(responses, key=lambda held: -held.ratio)[:_SHOWN]:
        figures = f"{format_duration(round(held.bound))} | {format_duration(round(held.seen))} | {held.ratio:.1f}"
        print(f"| {held.style} | {held.seed} | {held.name} | `{held.tier}` | {figures} |")


def _describe_ratios(ratios: list[float]) -> tuple[str, str, str, str]:
    if not ratios:
        return "0", "", "", ""
    ratios = sorted(ratios)
    upper = ratios[int(0.95 * (len(ratios) - 1))]
    return str(len(ratios)), f"{statistics.median(ratios):.2f}", f"{upper:.2f}", f"{ratios[-1]:.1f}"


if __name__ == "__main__":
    numbers = [int(argument) for argument in sys.argv[1:]]
    first, last, runs = (*numbers, *(0, 105, 16)[len(numbers) :])
    print_tables(list(hold_bounds(first, last, runs)))
