"""One run of a plan by one seed: its dice, its state, and what is to happen next."""

from __future__ import annotations

from collections.abc import Collection
from random import Random

from archgen.simulation.plan import KEPT, Plan
from archgen.simulation.state import CRITICAL, Steps, Threads, Wires

END, ARRIVAL, RELEASE = range(3)
"""The order of events at one moment."""
TICK, LATE, HELD = range(3)
"""Releases: a clock's tick, one that its jitter held back, and what data fired and jitter held back."""
NOBODY, SEVERAL, LOAD = -1, -2, -3
"""What fired a job, where no one wire did: a clock, all of several, or nobody (it only loads its host)."""


class Run:
    """One run by one seed. Read `steps`, `wires`, `threads` and `events` when it is over."""

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
        self.worst_share = [1.0 if self.critical else dice.choice((0.2, 0.6, 0.9)) for _ in plan.steps]
        self.publish_share = [dice.choice((0.1, 0.5, 0.9)) for _ in plan.steps]
        self.priority = [step.priority for step in plan.steps]
        self.calls = [step.calls for step in plan.steps]
        self.outputs = [
            tuple((at, o.wires, o.conditional, o.patience) for at, o in enumerate(step.outputs) if step.kind != KEPT)
            for step in plan.steps
        ]
        self.heap: list[tuple[int, int, int]] = []
        """Key (moment and order of events), what, which."""
        self.awake: list[int] = []
        """Threads that got something to do at this moment."""
        self.touched: set[int] = set()
        """Processors with a free core or a new thread at this moment."""
        self.sequence = 0
        self.answers = [plan.answers.get(e, -1) for e in range(len(plan.wires))]
        self.events = 0

    def between(self, at: int, low: int, spread: int) -> int:
        """Draw a time, the extremes more often than what lies between."""
        drawn = self.random()
        share = self.worst_share[at]
        if drawn < share:
            return low + spread
        rest = (drawn - share) / (1.0 - share)
        return low if rest < 0.5 else low + int((rest - 0.5) * 2.0 * (spread + 1))  # noqa: PLR2004 - half of the rest
