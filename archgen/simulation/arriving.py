"""Samples arrive: they fire their reader, fill a place among all that must be there, or are kept to be read."""

from __future__ import annotations

from archgen.simulation.firing import fire, hold, passes
from archgen.simulation.plan import ANY, SAMPLED
from archgen.simulation.run import SEVERAL, Run


def deliver(run: Run, now: int, wire: int, sample: int) -> None:
    """Let a sample arrive: it fires its reader, fills a place among all that must be there, or is kept."""
    wires, steps = run.wires, run.steps
    slot = wires.slot[wire]
    if slot == SAMPLED:
        wires.newest[wire] = sample
        queue = wires.queue[wire]
        if wires.request[wire]:
            steps.asked[wires.target[wire]].append(wire)
        elif queue >= 0:
            wires.waiting[queue] += 1
            if wires.waiting[queue] > wires.depth[wire] > 0:
                wires.drops[queue] += 1
    elif slot == ANY:
        at = wires.target[wire]
        if wires.request[wire]:
            fire(run, now, at, wire, sample)
        elif steps.gated[at] and not passes(run, now, at):
            wires.newest[wire] = sample
        elif steps.jitter[at]:
            hold(run, now, at, wire, sample)
        else:
            enqueue(run, now, wire, sample)
    else:
        _fill(run, now, wire, slot, sample)


def enqueue(run: Run, now: int, wire: int, sample: int) -> None:
    """Put a sample into the queue of a reader that it fires; from a full one the oldest goes."""
    wires, at, queue = run.wires, run.wires.target[wire], run.wires.queue[wire]
    if wires.waiting[queue] == wires.depth[wire] > 0:
        _drop(run, at, queue)
    wires.waiting[queue] += 1
    fire(run, now, at, wire, sample)


def _drop(run: Run, at: int, queue: int) -> None:
    """Throw away the oldest sample of a queue."""
    pending, wires = run.steps.pending[at], run.wires
    for place, (_, wire, _) in enumerate(pending):
        if wire >= 0 and wires.queue[wire] == queue:
            del pending[place]
            wires.waiting[queue] -= 1
            wires.drops[queue] += 1
            return


def _fill(run: Run, now: int, wire: int, slot: int, sample: int) -> None:
    wires, steps = run.wires, run.steps
    at = wires.target[wire]
    step = run.plan.steps[at]
    wires.arrived[wire] = sample
    if steps.mask[at] >> slot & 1 and slot not in step.kept:
        wires.drops[wires.queue[wire]] += 1
    steps.mask[at] |= 1 << slot
    if steps.mask[at] == (1 << step.slots) - 1:
        steps.mask[at] = sum(1 << kept for kept in step.kept)
        if not steps.gated[at] or passes(run, now, at):
            go_on = hold if steps.jitter[at] else fire
            go_on(run, now, at, SEVERAL, tuple([wires.arrived[e] for e in step.captured]))
        else:
            for one in step.captured:
                wires.newest[one] = wires.arrived[one]
