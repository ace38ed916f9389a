"""Handle samples that arrive at their reader: fire it, fill one of the slots that must all be filled, or keep the
sample.
"""

from __future__ import annotations

from collections.abc import Sequence

from archgen.simulation.job_activation import (
    fire_activity,
    hold_firing,
    keep_sample,
    passes_gate,
    queue_callback,
    stamp_of,
)
from archgen.simulation.simulation_plan import SLOT_ANY, SLOT_SAMPLED
from archgen.simulation.simulation_run import ALL_WIRES, SimulationRun


def deliver_sample(run: SimulationRun, now: int, wire: int, sample: int) -> None:
    """Deliver a sample at time `now`: fire its reader, fill a slot of an all-of trigger, or keep it."""
    wires, activities = run.wires, run.activities
    slot = wires.slot[wire]
    if run.start_up.awaited_wires[wires.target[wire]]:
        run.start_up.note_sample(wires.source[wire], wires.target[wire], wire, sample)
    if slot == SLOT_SAMPLED:
        if wires.is_request[wire]:
            wires.newest_job[wire] = sample
            activities.waiting_requests[wires.target[wire]].append(wire)
        elif wires.callback[wire] >= 0:
            _queue_storing(run, now, wire, sample)
        else:
            store_sample(run, wire, sample)
    elif slot == SLOT_ANY:
        _fire_by_any(run, now, wire, sample)
    elif activities.matchers[wires.target[wire]] is not None:
        _match_sample(run, now, wire, slot, sample)
    else:
        _fill_slot(run, now, wire, slot, sample)


def _fire_by_any(run: SimulationRun, now: int, wire: int, sample: int) -> None:
    """Fire a reader that any of its inputs fires, if its gates let the sample pass."""
    wires, activities = run.wires, run.activities
    activity = wires.target[wire]
    if wires.is_request[wire]:
        fire_activity(run, now, activity, wire, sample)
    # `every` and `throttle` come before jitter: a throttle measures from what it let through, not from when jitter
    # released it.
    elif activities.is_gated[activity] and not passes_gate(run, now, activity):
        if run.plan.activities[activity].keeps_dropped:
            keep_sample(run, wire, sample)
    elif activities.jitter[activity]:
        hold_firing(run, now, activity, wire, sample)
    else:
        enqueue_sample(run, now, wire, sample)


def store_sample(run: SimulationRun, wire: int, sample: int) -> None:
    """Store a sample that fires nobody: from now on it is what the reader's next job reads."""
    wires = run.wires
    keep_sample(run, wire, sample)
    queue = wires.queue[wire]
    if queue >= 0:
        wires.waiting_count[queue] += 1
        # Nothing is removed, since only the newest sample is ever read. `waiting_count` goes back to 0 when the
        # reader starts: what exceeds `depth` until then was lost.
        if wires.waiting_count[queue] > wires.depth[wire] > 0:
            wires.drop_count[queue] += 1


def _queue_storing(run: SimulationRun, now: int, wire: int, sample: int) -> None:
    """Queue a sample for the callback that stores it; a full queue keeps the last ones."""
    callback = run.wires.callback[wire]
    pending = run.callbacks.pending[callback]
    if len(pending) == run.callbacks.depth[callback] > 0:
        pending.popleft()
        run.executors.waiting_count[run.callbacks.executor[callback]] -= 1
        run.wires.drop_count[run.wires.queue[wire]] += 1
    queue_callback(run, callback, (now, wire, sample, run.sequence))


def enqueue_sample(run: SimulationRun, now: int, wire: int, sample: int) -> None:
    """Queue a sample that fires its reader; a full queue drops its oldest sample first."""
    wires, activity, queue = run.wires, run.wires.target[wire], run.wires.queue[wire]
    # A depth of 0 means that no limit is known: the chained comparison is then never true.
    if wires.waiting_count[queue] == wires.depth[wire] > 0:
        _drop_oldest(run, wires.callback[wire], queue)
    wires.waiting_count[queue] += 1
    fire_activity(run, now, activity, wire, sample)


def _drop_oldest(run: SimulationRun, callback: int, queue: int) -> None:
    """Remove the oldest pending job of a queue, and count the drop."""
    pending, wires = run.callbacks.pending[callback], run.wires
    # What only loads the host waits here as well, and came from no queue.
    for position, (_, wire, _, _) in enumerate(pending):
        if wire >= 0 and wires.queue[wire] == queue:
            del pending[position]
            run.executors.waiting_count[run.callbacks.executor[callback]] -= 1
            wires.waiting_count[queue] -= 1
            wires.drop_count[queue] += 1
            return


def _fill_slot(run: SimulationRun, now: int, wire: int, slot: int, sample: int) -> None:
    """Fill one slot of an all-of trigger; when every slot is filled, activate the reader and clear the slots."""
    wires, activities = run.wires, run.activities
    activity = wires.target[wire]
    planned = run.plan.activities[activity]
    wires.arrived_job[wire] = sample
    for rival in wires.rivals[wire]:
        wires.arrived_job[rival] = -1
    # A filled slot whose sample is replaced loses that sample. Slots of inputs published once are always filled.
    if activities.filled_slots[activity] >> slot & 1 and slot not in planned.constant_slots:
        wires.drop_count[wires.queue[wire]] += 1
    activities.filled_slots[activity] |= 1 << slot
    if activities.filled_slots[activity] == (1 << planned.slot_count) - 1:
        activities.filled_slots[activity] = sum(1 << constant_slot for constant_slot in planned.constant_slots)
        _fire_jointly(run, now, activity, [wires.arrived_job[input_wire] for input_wire in planned.captured_wires])


def _match_sample(run: SimulationRun, now: int, wire: int, slot: int, sample: int) -> None:
    """Let a sample wait for those of the same time, and activate the reader for each set that is complete."""
    wires, activity = run.wires, run.wires.target[wire]
    matcher = run.activities.matchers[activity]
    if matcher is None:
        return
    for matched_samples in matcher.add_sample(slot, (stamp_of(run, wire, sample), wire, sample)):
        job_by_wire = {matched_wire: job_number for _, matched_wire, job_number in matched_samples}
        captured_wires = run.plan.activities[activity].captured_wires
        _fire_jointly(run, now, activity, [job_by_wire.get(captured_wire, -1) for captured_wire in captured_wires])
    for dropped_wire in matcher.dropped_wires:
        wires.drop_count[wires.queue[dropped_wire]] += 1
    matcher.dropped_wires.clear()


def _fire_jointly(run: SimulationRun, now: int, activity: int, samples: Sequence[int]) -> None:
    """Activate a reader by samples of several inputs, one for each captured wire (-1: none), if its gates let them pass."""
    activities, planned = run.activities, run.plan.activities[activity]
    if not activities.is_gated[activity] or passes_gate(run, now, activity):
        if activities.jitter[activity]:
            hold_firing(run, now, activity, ALL_WIRES, tuple(samples))
        else:
            fire_activity(run, now, activity, ALL_WIRES, tuple(samples))
    elif planned.keeps_dropped:
        # A rejected activation still makes its samples the newest: a later call of the same reader reads them.
        for wire, sample in zip(planned.captured_wires, samples, strict=True):
            if sample >= 0:
                keep_sample(run, wire, sample)
