"""Handle samples that arrive at their reader: fire it, fill one of the slots that must all be filled, or keep the
sample.
"""

from __future__ import annotations

from archgen.simulation.firing import fire, hold, passes
from archgen.simulation.plan import ANY, SAMPLED
from archgen.simulation.run import SEVERAL, Run


def deliver(run: Run, now: int, wire: int, sample: int) -> None:
    """Deliver a sample at time `now`: fire its reader, fill a slot of an all-of trigger, or keep it."""
    wires, steps = run.wires, run.steps
    slot = wires.slot[wire]
    if slot == SAMPLED:
        wires.newest[wire] = sample
        queue = wires.queue[wire]
        if wires.request[wire]:
            steps.asked[wires.target[wire]].append(wire)
        elif queue >= 0:
            wires.waiting[queue] += 1
            # Nothing is removed, since only the newest sample is ever read. `waiting_count` goes back to 0 when the
            # reader starts: what exceeds `depth` until then was lost.
            if wires.waiting[queue] > wires.depth[wire] > 0:
                wires.drops[queue] += 1
    elif slot == ANY:
        at = wires.target[wire]
        if wires.request[wire]:
            fire(run, now, at, wire, sample)
        # `every` and `throttle` come before jitter: a throttle measures from what it let through, not from when jitter
        # released it.
        elif steps.gated[at] and not passes(run, now, at):
            wires.newest[wire] = sample
        elif steps.jitter[at]:
            hold(run, now, at, wire, sample)
        else:
            enqueue(run, now, wire, sample)
    else:
        _fill(run, now, wire, slot, sample)


def enqueue(run: Run, now: int, wire: int, sample: int) -> None:
    """Queue a sample that fires its reader; a full queue drops its oldest sample first."""
    wires, at, queue = run.wires, run.wires.target[wire], run.wires.queue[wire]
    # A depth of 0 means that no limit is known: the chained comparison is then never true.
    if wires.waiting[queue] == wires.depth[wire] > 0:
        _drop(run, at, queue)
    wires.waiting[queue] += 1
    fire(run, now, at, wire, sample)


def _drop(run: Run, at: int, queue: int) -> None:
    """Remove the oldest pending job of a queue, and count the drop."""
    pending, wires = run.steps.pending[at], run.wires
    # Several queues share one deque of pending jobs, so the oldest of this queue need not be the first one.
    for place, (_, wire, _) in enumerate(pending):
        if wire >= 0 and wires.queue[wire] == queue:
            del pending[place]
            wires.waiting[queue] -= 1
            wires.drops[queue] += 1
            return


def _fill(run: Run, now: int, wire: int, slot: int, sample: int) -> None:
    """Fill one slot of an all-of trigger; when every slot is filled, activate the reader and clear the slots."""
    wires, steps = run.wires, run.steps
    at = wires.target[wire]
    step = run.plan.steps[at]
    wires.arrived[wire] = sample
    # A filled slot whose sample is replaced loses that sample. Slots of inputs published once are always filled.
    if steps.mask[at] >> slot & 1 and slot not in step.kept:
        wires.drops[wires.queue[wire]] += 1
    steps.mask[at] |= 1 << slot
    if steps.mask[at] == (1 << step.slots) - 1:
        steps.mask[at] = sum(1 << kept for kept in step.kept)
        if not steps.gated[at] or passes(run, now, at):
            go_on = hold if steps.jitter[at] else fire
            go_on(run, now, at, SEVERAL, tuple([wires.arrived[e] for e in step.captured]))
        else:
            # A rejected activation still makes its samples the newest: a later call of the same reader reads them.
            for one in step.captured:
                wires.newest[one] = wires.arrived[one]
