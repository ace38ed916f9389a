"""One run of a plan with one seed: its random numbers, its state, and its pending events."""

from __future__ import annotations

from collections.abc import Collection
from random import Random

from archgen.simulation.plan import KEPT, Plan
from archgen.simulation.state import CRITICAL, Steps, Threads, Wires

END, ARRIVAL, RELEASE = range(3)
"""The order of events at one moment; two bits of the heap's keys."""
TICK, LATE, HELD = range(3)
"""Kinds of releases: a clock tick, a tick that jitter delayed, and an activation by data that jitter held back."""
NOBODY, SEVERAL, LOAD = -1, -2, -3
"""What fired a job where no single wire did: a clock, all inputs together, or nothing (it only loads its host)."""


class Run:
    """One run with one seed. Read `activities`, `wires`, `threads` and `event_count` when it is over."""

    __slots__ = (
        "answers",
        "awake",
        "calls",
        "critical",
        "events",
        "heap",
        "outputs",
        "plan",
        "priority",
        "publish_share",
        "random",
        "sequence",
        "steps",
        "threads",
        "touched",
        "wires",
        "worst_share",
    )

    def __init__(self, plan: Plan, seed: int, watched: Collection[int] = (), logged: Collection[int] = ()) -> None:
        dice = Random(seed)  # noqa: S311 - dice, not secrets
        self.plan = plan
        self.random = dice.random
        self.critical = seed % CRITICAL == 0
        self.steps = Steps(plan, dice, watched)
        self.wires = Wires(plan, logged)
        self.threads = Threads(plan, dice)
        if self.critical:
            self.steps.phase = [0] * len(plan.steps)
        # Drawn for each run and activity: some runs see mostly the longest times, others mostly what lies below.
        self.worst_share = [1.0 if self.critical else dice.choice((0.2, 0.6, 0.9)) for _ in plan.steps]
        self.publish_share = [dice.choice((0.1, 0.5, 0.9)) for _ in plan.steps]
        self.priority = [step.priority for step in plan.steps]
        self.calls = [step.calls for step in plan.steps]
        self.outputs = [
            # What is published once was delivered at the start, and never again.
            tuple((at, o.wires, o.conditional, o.patience) for at, o in enumerate(step.outputs) if step.kind != KEPT)
            for step in plan.steps
        ]
        self.heap: list[tuple[int, int, int]] = []
        """Events: key (time and order), subject, detail."""
        self.awake: list[int] = []
        """Threads that got something to do at this moment."""
        self.touched: set[int] = set()
        """Processors with a free core or a newly ready thread at this moment."""
        self.sequence = 0
        self.answers = [plan.answers.get(e, -1) for e in range(len(plan.wires))]
        self.events = 0

    def between(self, at: int, low: int, spread: int) -> int:
        """Draw a time between `low` and `low + spread`; the extremes are drawn more often than what lies between."""
        drawn = self.random()
        share = self.worst_share[at]
        if drawn < share:
            return low + spread
        # One random number is used twice: rescaled to 0..1, its lower half means the shortest time.
        rest = (drawn - share) / (1.0 - share)
        return low if rest < 0.5 else low + int((rest - 0.5) * 2.0 * (spread + 1))  # noqa: PLR2004 - half of the rest
