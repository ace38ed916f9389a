package archgen.runtime;

import java.util.List;

/** Decides which values make a component active. */
final class Activation {
    private final Timing timing;
    private final List<InPort<?>> inputs;
    private long sets;
    private boolean wasActive;
    private long lastNs;

    Activation(Timing timing, List<InPort<?>> inputs) {
        this.timing = timing;
        this.inputs = inputs;
    }

    /** Take a value that arrives; say whether the component is active now. */
    boolean accept(InPort<?> port, Object value, long timeNs) {
        if (!timing.triggers().contains(port.name)) {
            port.store(value, timeNs);
            return false;
        }
        boolean isComplete = completes(port, timeNs);
        boolean isTaken = !isComplete || passes(timeNs);
        if (isTaken || timing.keepsDropped()) {
            port.store(value, timeNs);
        } else {
            port.stamp(timeNs);
        }
        if (isComplete) {
            triggers().forEach(each -> each.setAwaited(true));
        }
        return isComplete && isTaken;
    }

    private boolean completes(InPort<?> port, long timeNs) {
        return switch (timing.mode()) {
            case ANY -> true;
            case ALL -> triggers().stream().noneMatch(each -> each != port && each.isAwaited());
            case MATCH -> matches(port, timeNs);
            default -> false;
        };
    }

    /** What arrived too long ago is given up: its input waits for another value. */
    private boolean matches(InPort<?> port, long timeNs) {
        for (InPort<?> each : triggers()) {
            if (each != port && timeNs - each.arrivalNs() > timing.withinNs()) {
                each.setAwaited(true);
            }
        }
        return triggers().stream().noneMatch(each -> each != port && each.isAwaited());
    }

    private boolean passes(long timeNs) {
        sets++;
        if (sets % timing.every() != 0 || wasActive && timeNs - lastNs < timing.throttleNs()) {
            return false;
        }
        wasActive = true;
        lastNs = timeNs;
        return true;
    }

    private List<InPort<?>> triggers() {
        return inputs.stream().filter(each -> timing.triggers().contains(each.name)).toList();
    }
}
