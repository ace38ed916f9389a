"""One run of a plan: events on a heap, in units of time that are integers.

At one moment ends come first, then arrivals, then releases; when all of them are done, threads are given to cores. The
inner loop is written for speed: it works on lists by small integers and makes no objects but tuples.
"""

from __future__ import annotations

from collections.abc import Collection
from heapq import heapify, heappop, heappush
from random import Random
from typing import Any

from archgen.simulation.plan import ANY, KEPT, PERIODIC, SAMPLED, Plan
from archgen.simulation.state import CRITICAL, FIFO, LAST_FIRST, LOTTERY, RANKS, Job, Steps, Threads, Wires

END, ARRIVAL, RELEASE = range(3)
"""The order of events at one moment."""
_LATER = 1 << 61
_NOBODY, _SEVERAL, _LOAD = -1, -2, -3


class Run:
    """One run by one seed. Read `steps`, `wires`, `threads` and `events` after `go`."""

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
        self.awake: list[int] = []
        """Threads that got something to do at this moment."""
        self.touched: set[int] = set()
        """Processors with a free core or a new thread at this moment."""
        self.sequence = 0
        self.answers = [plan.answers.get(e, -1) for e in range(len(plan.wires))]
        self.events = 0

    def go(self, horizon: int) -> None:
        """Run until a moment."""
        self._begin()
        heap, steps = self.heap, self.steps
        arrive, ended, pop = self.deliver, self._ended, heappop
        now = popped = 0
        while heap:
            key = heap[0][0]
            if key >> 2 > now:
                if self.awake or self.touched:
                    self._dispatch(now)
                    continue
                now = key >> 2
                if now > horizon:
                    break
            _, what, which = pop(heap)
            popped += 1
            order = key & 3
            if order == ARRIVAL:
                arrive(now, what, which)
            elif order == RELEASE:
                self._release(now, what, which)
            elif what >= 0:
                ended(now, what, which)
            else:
                self._keep_promise(now, -1 - what)
        self.events = popped + sum(steps.started) + self.wires.sent

    def _begin(self) -> None:
        """Publish what is published once, and set the clocks."""
        for at, step in enumerate(self.plan.steps):
            if step.kind == KEPT:
                for output in step.outputs:
                    for wire in output.wires:
                        self.wires.newest[wire] = self.wires.arrived[wire] = 0
            elif step.kind == PERIODIC:
                self.heap.append((self.steps.phase[at] << 2 | RELEASE, at, 0))
        heapify(self.heap)

    def _release(self, now: int, at: int, late: int) -> None:
        steps = self.steps
        if not late:
            heappush(self.heap, (now + steps.period[at] << 2 | RELEASE, at, 0))
            jitter = steps.jitter[at]
            if jitter:
                delay = self._between(at, 0, jitter)
                if delay:
                    heappush(self.heap, (now + delay << 2 | RELEASE, at, 1))
                    return
        if not steps.gated[at] or self._passes(now, at):
            self._fire(now, at, _NOBODY, 0)

    def _between(self, at: int, low: int, spread: int) -> int:
        """Draw a time, the extremes more often than what lies between."""
        drawn = self.random()
        share = self.worst_share[at]
        if drawn < share:
            return low + spread
        rest = (drawn - share) / (1.0 - share)
        return low if rest < 0.5 else low + int((rest - 0.5) * 2.0 * (spread + 1))  # noqa: PLR2004 - half of the rest

    def _passes(self, now: int, at: int) -> bool:
        """Say whether an activation gets through `every` and `throttle`."""
        step, steps = self.plan.steps[at], self.steps
        if step.every > 1:
            steps.turn[at] = (steps.turn[at] + 1) % step.every
            if steps.turn[at]:
                return False
        return not (step.throttle and steps.fired[at] >= 0 and now - steps.fired[at] < step.throttle)

    def _fire(self, now: int, at: int, wire: int, sample: Any) -> None:  # noqa: ANN401 - see Job
        steps = self.steps
        before = steps.fired[at]
        if before >= 0 and now - before > steps.firing_gap[at]:
            steps.firing_gap[at] = now - before
        steps.fired[at] = now
        if steps.promised[at] is not None:
            self._promise(now, at, wire, sample)
            wire = _LOAD
        steps.pending[at].append((now, wire, sample))
        thread = steps.thread[at]
        if self.threads.idle[thread]:
            self.awake.append(thread)

    def deliver(self, now: int, wire: int, sample: int) -> None:
        """Let a sample arrive: it fires its reader, fills a place among all that must be there, or is kept."""
        wires, steps = self.wires, self.steps
        slot = wires.slot[wire]
        if slot == ANY:
            at = wires.target[wire]
            if wires.request[wire]:
                self._fire(now, at, wire, sample)
            elif steps.gated[at] and not self._passes(now, at):
                wires.newest[wire] = sample
            else:
                queue = wires.queue[wire]
                if wires.waiting[queue] == wires.depth[wire] > 0:
                    self._drop(at, queue)
                wires.waiting[queue] += 1
                self._fire(now, at, wire, sample)
        elif slot == SAMPLED:
            wires.newest[wire] = sample
            queue = wires.queue[wire]
            if wires.request[wire]:
                steps.asked[wires.target[wire]].append(wire)
            elif queue >= 0:
                wires.waiting[queue] += 1
                if wires.waiting[queue] > wires.depth[wire] > 0:
                    wires.drops[queue] += 1
        else:
            self._fill(now, wire, slot, sample)

    def _drop(self, at: int, queue: int) -> None:
        """Throw away the oldest sample of a queue."""
        pending, wires = self.steps.pending[at], self.wires
        for place, (_, wire, _) in enumerate(pending):
            if wire >= 0 and wires.queue[wire] == queue:
                del pending[place]
                wires.waiting[queue] -= 1
                wires.drops[queue] += 1
                return

    def _fill(self, now: int, wire: int, slot: int, sample: int) -> None:
        wires, steps = self.wires, self.steps
        at = wires.target[wire]
        step = self.plan.steps[at]
        wires.arrived[wire] = sample
        if steps.mask[at] >> slot & 1 and slot not in step.kept:
            wires.drops[wires.queue[wire]] += 1
        steps.mask[at] |= 1 << slot
        if steps.mask[at] == (1 << step.slots) - 1:
            steps.mask[at] = sum(1 << kept for kept in step.kept)
            if not steps.gated[at] or self._passes(now, at):
                self._fire(now, at, _SEVERAL, tuple([wires.arrived[e] for e in step.captured]))

    def _read(self, now: int, at: int, job: Job) -> None:
        """Take in what fired a job, and what the other inputs hold."""
        steps, wires = self.steps, self.wires
        _, wire, sample = job
        if wire >= 0:
            wires.newest[wire] = sample
        elif wire == _SEVERAL:
            for one, number in zip(self.plan.steps[at].captured, sample, strict=True):
                wires.newest[one] = number
        for queue in wires.sampled[at]:
            wires.waiting[queue] = 0
        if steps.asked[at]:
            steps.taken[at] += steps.asked[at]
            steps.asked[at] = []
        if steps.watched[at]:
            steps.starts[at].append(now)
            steps.firings[at].append(job[0])
            for one in wires.logged[at]:
                wires.log[one].append(wires.newest[one])
        steps.started[at] += 1

    def _dispatch(self, now: int) -> None:
        """Choose what each thread does next, and give threads to cores."""
        threads = self.threads
        while self.awake:
            thread = self.awake.pop()
            if threads.idle[thread]:
                self._choose(thread)
        while self.touched:
            processor = self.touched.pop()
            ready, running = threads.ready[processor], threads.running[processor]
            if threads.mixed[processor]:
                self._assign(now, processor)
                continue
            while ready:
                if len(running) < threads.cores[processor]:
                    self._start(now, heappop(ready)[2], running)
                elif not threads.preemptive[processor] or not self._preempt(now, ready, running):
                    break

    def _assign(self, now: int, processor: int) -> None:
        """Give cores to threads some of which must have a certain one, the most urgent first."""
        threads = self.threads
        running = threads.running[processor]
        wanted = sorted(threads.ready[processor])
        if threads.preemptive[processor]:
            wanted = sorted([*wanted, *((threads.key[t], threads.order[t], t) for t in running)])
            taken: dict[int, int] = {}
        else:
            taken = {threads.core[t]: t for t in running}
        for _, _, thread in wanted:
            pin, last = threads.affinity[thread], threads.core[thread]
            cores = [pin] if pin >= 0 else [*([last] if thread in running else []), *range(threads.cores[processor])]
            core = next((one for one in cores if one not in taken), None)
            if core is not None:
                taken[core] = thread
        self._move(now, processor, taken)

    def _move(self, now: int, processor: int, taken: dict[int, int]) -> None:
        """Take threads off their cores that lost them, and start those that got one."""
        threads = self.threads
        running, ready = threads.running[processor], threads.ready[processor]
        for thread in [t for t in running if t not in taken.values()]:
            running.remove(thread)
            threads.version[thread] += 1
            threads.left[thread] = threads.until[thread] - now
            ready.append((threads.key[thread], threads.order[thread], thread))
        for core, thread in taken.items():
            threads.core[thread] = core
            if thread not in running:
                ready.remove((threads.key[thread], threads.order[thread], thread))
                self._start(now, thread, running)

    def _choose(self, thread: int) -> None:
        """Let an idle thread take up its next job, if there is one, and queue for a core."""
        threads, steps = self.threads, self.steps
        at = self._next(thread) if threads.shared[thread] else threads.members[thread][0]
        if at < 0 or not steps.pending[at]:
            return
        if threads.pool[thread] >= 0 and not self._enter(thread):
            return
        threads.idle[thread] = False
        threads.current[thread] = at
        threads.left[thread] = -1
        processor = threads.processor[thread]
        self.sequence += 1
        priority = self.priority[at]
        key = self._turn(at, thread, processor) if priority is None else -1 - priority
        threads.key[thread], threads.order[thread] = key, self.sequence
        heappush(threads.ready[processor], (key, self.sequence, thread))
        self.touched.add(processor)

    def _turn(self, at: int, thread: int, processor: int) -> int:
        """Give the place of a thread without a priority among its like; whoever has one comes first, below zero."""
        scheduler = self.threads.scheduler[processor]
        if scheduler == FIFO:
            return self.steps.pending[at][0][0]
        if scheduler == LAST_FIRST:
            return _LATER - self.sequence
        return int(self.random() * _LATER) if scheduler == LOTTERY else self.threads.rank[thread]

    def _enter(self, thread: int) -> bool:
        """Take one of a container's threads, or wait for one."""
        threads = self.threads
        pool = threads.pool[thread]
        if threads.free[pool]:
            threads.free[pool] -= 1
            return True
        if not threads.queued[thread]:
            threads.queued[thread] = True
            threads.queue[pool].append(thread)
        return False

    def _leave(self, pool: int) -> None:
        """Give one of a container's threads to who waits longest for it."""
        threads = self.threads
        threads.free[pool] += 1
        if threads.queue[pool]:
            thread = threads.queue[pool].popleft()
            threads.queued[thread] = False
            self.awake.insert(0, thread)

    def _next(self, thread: int) -> int:
        """Choose a callback as a single-threaded executor does: it sees who is ready, and serves all of these first."""
        steps, threads = self.steps, self.threads
        turns = threads.round[thread]
        while turns:
            at = turns.popleft()
            if steps.pending[at]:
                return at
        members = [at for at in threads.members[thread] if steps.pending[at]]
        clocks = [at for at in members if steps.period[at]]
        turns.extend(clocks)
        for at in members:
            if not steps.period[at]:
                turns.extend([at] * len({wire for _, wire, _ in steps.pending[at]}))
        return turns.popleft() if turns else -1

    def _start(self, now: int, thread: int, running: list[int]) -> None:
        threads, steps = self.threads, self.steps
        left = threads.left[thread]
        if left < 0:
            at = threads.current[thread]
            job = steps.pending[at].popleft()
            wire = job[1]
            if wire >= 0 and not self.wires.request[wire]:
                self.wires.waiting[self.wires.queue[wire]] -= 1
            steps.acted[at] = job[0]
            steps.request[at] = wire
            if wire != _LOAD:
                self._read(now, at, job)
            spread = steps.spread[at]
            left = self._between(at, steps.shortest[at], spread) if spread else steps.shortest[at]
            self.threads.busy[threads.processor[thread]] += left
            threads.left[thread] = left
        running.append(thread)
        threads.until[thread] = now + left
        heappush(self.heap, (now + left << 2 | END, thread, threads.version[thread]))

    def _preempt(self, now: int, ready: list[tuple[int, int, int]], running: list[int]) -> bool:
        """Take the least urgent running thread off its core, if a more urgent one waits."""
        threads = self.threads
        last = max(running, key=lambda t: (threads.key[t], threads.order[t]))
        key = ready[0][0]
        if key >= threads.key[last] or (key >= 0 and threads.scheduler[threads.processor[last]] != RANKS):
            return False
        running.remove(last)
        threads.version[last] += 1
        threads.left[last] = threads.until[last] - now
        heappush(ready, (threads.key[last], threads.order[last], last))
        return True

    def _ended(self, now: int, thread: int, version: int) -> None:
        threads = self.threads
        if threads.version[thread] != version:
            return
        threads.version[thread] += 1
        processor = threads.processor[thread]
        threads.running[processor].remove(thread)
        if threads.ready[processor]:
            self.touched.add(processor)
        at = threads.current[thread]
        self._complete(now, at)

    def _calls(self, at: int) -> list[int]:
        """Give the requests of one job, in order; of a fraction of a call, as many as are due."""
        found: list[int] = []
        due = self.steps.due[at]
        for place, (number, wires) in enumerate(self.calls[at]):
            total = due[place] + number.numerator
            due[place] = total % number.denominator
            found += wires * (total // number.denominator)
        return found

    def _complete(self, now: int, at: int) -> None:
        """End a job: note its response, publish, answer, and let the thread go on."""
        steps = self.steps
        wire = steps.request[at]
        if wire != _LOAD:
            self._finish(now, at, steps.acted[at], wire, steps.started[at] - 1)
        thread = steps.thread[at]
        self.threads.idle[thread] = True
        if self.threads.pool[thread] >= 0:
            self._leave(self.threads.pool[thread])
        if self.threads.shared[thread] or steps.pending[at]:
            self.awake.append(thread)

    def _note(self, now: int, at: int, response: int) -> None:
        """Note the end of a job."""
        steps = self.steps
        steps.worst[at] = max(steps.worst[at], response)
        if response < steps.best[at] or steps.best[at] < 0:
            steps.best[at] = response
        before = steps.end[at]
        if before >= 0 and now - before > steps.gap[at]:
            steps.gap[at] = now - before
        steps.end[at] = now
        steps.finished[at] += 1
        if steps.watched[at]:
            steps.ends[at].append(now)

    def _finish(self, now: int, at: int, fired: int, wire: int, number: int) -> None:
        """End a job's work: publish, and answer who waits for it."""
        steps = self.steps
        self._note(now, at, now - fired)
        if self.calls[at]:
            for request in self._calls(at):
                self._send(now, request, number)
        for place, targets, conditional, patience in self.outputs[at]:
            if not conditional or self._publishes(now, at, place, patience):
                for one in targets:
                    self._send(now, one, number)
        if wire >= 0 and self.answers[wire] >= 0:
            self._send(now, self.answers[wire], number)
        if steps.taken[at]:
            taken, steps.taken[at] = steps.taken[at], []
            for request in taken:
                self._send(now, self.answers[request], number)

    def _publishes(self, now: int, at: int, place: int, patience: int | None) -> bool:
        """Decide on a conditional output; it is never silent for longer than was promised."""
        published, silence = self.steps.published[at], self.steps.silence[at]
        last = published[place]
        if self.random() >= self.publish_share[at] and (patience is None or (last >= 0 and now - last <= patience)):
            return False
        if last >= 0 and now - last > silence[place]:
            silence[place] = now - last
        published[place] = now
        return True

    def _send(self, now: int, wire: int, sample: int) -> None:
        """Send a sample, over the link if there is one; samples of one wire keep their order."""
        wires = self.wires
        if wires.direct[wire]:
            wires.sent += 1
            self.deliver(now, wire, sample)
            return
        spread = wires.spread[wire]
        there = now + (self._between(wires.target[wire], wires.best[wire], spread) if spread else wires.best[wire])
        if wires.link[wire] >= 0:
            there = self._over_link(now, there, wire)
        there = wires.last[wire] = max(there, wires.last[wire])
        heappush(self.heap, (there << 2 | ARRIVAL, wire, sample))

    def _over_link(self, now: int, there: int, wire: int) -> int:
        """Queue for a link's bandwidth. A declared latency holds with the queueing in it, and is kept in any case."""
        wires = self.wires
        link, limit = wires.link[wire], wires.limit[wire]
        sent = max(now, wires.link_free[link]) + wires.transmission[wire]
        wires.link_free[link] = sent
        wires.link_busy[link] += wires.transmission[wire]
        wires.link_wait[link] = max(wires.link_wait[link], sent - now)
        there = max(there, sent)
        return there if limit is None else min(there, now + limit)

    def _promise(self, now: int, at: int, wire: int, sample: Any) -> None:  # noqa: ANN401 - see Job
        """Start a job whose end was declared: whatever the load, it ends in the declared time."""
        steps = self.steps
        job = (now, wire, sample)
        if wire >= 0 and not self.wires.request[wire]:
            self.wires.waiting[self.wires.queue[wire]] -= 1
        self._read(now, at, job)
        promised = steps.promised[at] or 0
        low = min(steps.shortest[at], promised)
        end = max(now + self._between(at, low, promised - low), steps.promise_end[at])
        steps.promise_end[at] = end
        steps.promises[at].append((now, wire, steps.started[at] - 1))
        heappush(self.heap, (end << 2 | END, -1 - at, 0))

    def _keep_promise(self, now: int, at: int) -> None:
        fired, wire, number = self.steps.promises[at].popleft()
        self._finish(now, at, fired, wire, number)
