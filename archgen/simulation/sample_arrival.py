"""Handle samples that arrive at their reader: fire it, fill one of the slots that must all be filled, or keep the
sample.
"""

from __future__ import annotations

from archgen.simulation.job_activation import fire_activity, hold_firing, passes_gate
from archgen.simulation.simulation_plan import SLOT_ANY, SLOT_SAMPLED
from archgen.simulation.simulation_run import ALL_WIRES, SimulationRun


def deliver_sample(run: SimulationRun, now: int, wire: int, sample: int) -> None:
    """Deliver a sample at time `now`: fire its reader, fill a slot of an all-of trigger, or keep it."""
    wires, activities = run.wires, run.activities
    slot = wires.slot[wire]
    if slot == SLOT_SAMPLED:
        wires.newest_job[wire] = sample
        queue = wires.queue[wire]
        if wires.is_request[wire]:
            activities.waiting_requests[wires.target[wire]].append(wire)
        elif queue >= 0:
            wires.waiting_count[queue] += 1
            # Nothing is removed, since only the newest sample is ever read. `waiting_count` goes back to 0 when the
            # reader starts: what exceeds `depth` until then was lost.
            if wires.waiting_count[queue] > wires.depth[wire] > 0:
                wires.drop_count[queue] += 1
    elif slot == SLOT_ANY:
        activity = wires.target[wire]
        if wires.is_request[wire]:
            fire_activity(run, now, activity, wire, sample)
        # `every` and `throttle` come before jitter: a throttle measures from what it let through, not from when jitter
        # released it.
        elif activities.is_gated[activity] and not passes_gate(run, now, activity):
            wires.newest_job[wire] = sample
        elif activities.jitter[activity]:
            hold_firing(run, now, activity, wire, sample)
        else:
            enqueue_sample(run, now, wire, sample)
    else:
        _fill_slot(run, now, wire, slot, sample)


def enqueue_sample(run: SimulationRun, now: int, wire: int, sample: int) -> None:
    """Queue a sample that fires its reader; a full queue drops its oldest sample first."""
    wires, activity, queue = run.wires, run.wires.target[wire], run.wires.queue[wire]
    # A depth of 0 means that no limit is known: the chained comparison is then never true.
    if wires.waiting_count[queue] == wires.depth[wire] > 0:
        _drop_oldest(run, activity, queue)
    wires.waiting_count[queue] += 1
    fire_activity(run, now, activity, wire, sample)


def _drop_oldest(run: SimulationRun, activity: int, queue: int) -> None:
    """Remove the oldest pending job of a queue, and count the drop."""
    pending, wires = run.activities.pending[activity], run.wires
    # Several queues share one deque of pending jobs, so the oldest of this queue need not be the first one.
    for position, (_, wire, _) in enumerate(pending):
        if wire >= 0 and wires.queue[wire] == queue:
            del pending[position]
            wires.waiting_count[queue] -= 1
            wires.drop_count[queue] += 1
            return


def _fill_slot(run: SimulationRun, now: int, wire: int, slot: int, sample: int) -> None:
    """Fill one slot of an all-of trigger; when every slot is filled, activate the reader and clear the slots."""
    wires, activities = run.wires, run.activities
    activity = wires.target[wire]
    planned = run.plan.activities[activity]
    wires.arrived_job[wire] = sample
    # A filled slot whose sample is replaced loses that sample. Slots of inputs published once are always filled.
    if activities.filled_slots[activity] >> slot & 1 and slot not in planned.constant_slots:
        wires.drop_count[wires.queue[wire]] += 1
    activities.filled_slots[activity] |= 1 << slot
    if activities.filled_slots[activity] == (1 << planned.slot_count) - 1:
        activities.filled_slots[activity] = sum(1 << constant_slot for constant_slot in planned.constant_slots)
        if not activities.is_gated[activity] or passes_gate(run, now, activity):
            activate = hold_firing if activities.jitter[activity] else fire_activity
            activate(
                run,
                now,
                activity,
                ALL_WIRES,
                tuple([wires.arrived_job[input_wire] for input_wire in planned.captured_wires]),
            )
        else:
            # A rejected activation still makes its samples the newest: a later call of the same reader reads them.
            for captured_wire in planned.captured_wires:
                wires.newest_job[captured_wire] = wires.arrived_job[captured_wire]
