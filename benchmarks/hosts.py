"""How many bounds are missing where events go to and fro between hosts, by the load of the fullest one: with ways as wholes
and without them, and how much of what a simulation sees the bounds are.

Usage: python benchmarks/hosts.py [LAST] [pinned] [gates] [ranked] [fair], systems 0 to 199 where nothing is said; with `fair` hosts
share their cores as Linux does it, else in any order.
"""

from __future__ import annotations

import statistics
import sys
from collections import defaultdict
from pathlib import Path

_ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(_ROOT))

from refinements import REFINEMENTS, without  # noqa: E402

from archgen.timing.run_analysis import analyse_architecture  # noqa: E402 - the checkout is what is measured
from tests.timing.random_systems import architecture  # noqa: E402
from tests.timing.random_transactions import draw_system  # noqa: E402

_LOADS = (0.15, 0.25, 0.4, 0.5)


def _name_load(load: float) -> str:
    upper = next((each for each in _LOADS if load < each), None)
    return f"below {upper:.0%}" if upper else f"{_LOADS[-1]:.0%} and more"


def main() -> None:
    """Print the table as Markdown."""
    numbers = [int(word) for word in sys.argv[1:] if word.isdigit()]
    kinds = {word: True for word in sys.argv[1:] if not word.isdigit()}
    is_fair = kinds.pop("fair", False)
    (as_wholes,) = (each for each in REFINEMENTS if each.place == "load.transactions:find_transactions")
    missing: dict[str, list[tuple[bool, bool]]] = defaultdict(list)
    ratios: dict[str, list[float]] = defaultdict(list)
    for seed in range(numbers[0] if numbers else 200):
        drawn = draw_system(seed, **kinds)
        model = architecture(drawn.text, is_fair=is_fair)
        found = analyse_architecture(model).responses
        with without(as_wholes):
            before = analyse_architecture(model).responses
        for name in drawn.steps:
            old, new = before[name].worst.value, found[name].worst.value
            missing[_name_load(drawn.load)].append((old is None, new is None))
            if old is not None and new:
                ratios[_name_load(drawn.load)].append(float(old / new))
    print("| load | responses | none before | none now | smaller now | by (median) |\n|---|---|---|---|---|---|")
    for load in sorted(missing):
        before_count, now_count = (sum(each) for each in zip(*missing[load], strict=True))
        smaller = [ratio for ratio in ratios[load] if ratio > 1]
        median = f"{statistics.median(smaller):.2f}" if smaller else ""
        total = len(missing[load])
        print(
            f"| {load} | {total} | {before_count / total:.1%} | {now_count / total:.1%} | {len(smaller)} | {median} |"
        )


if __name__ == "__main__":
    main()
