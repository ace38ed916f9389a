package archgen.runtime;

import java.util.ArrayList;
import java.util.List;
import java.util.Optional;

/**
 * An input: it holds what arrived.
 *
 * @param <T> the type of its values
 */
public final class InPort<T> extends Port {
    private final Class<T> type;
    private final List<T> fresh = new ArrayList<>();
    private T latest;
    private long arrivalNs;
    private boolean isAwaited = true;

    InPort(Component component, String name, Class<T> type) {
        super(component, name);
        this.type = type;
    }

    /**
     * Return the newest value.
     *
     * @return the value; empty as long as none arrived
     */
    public Optional<T> latest() {
        return Optional.ofNullable(latest);
    }

    /**
     * Return what arrived since the component was active last.
     *
     * @return the values, the oldest first
     */
    public List<T> fresh() {
        return List.copyOf(fresh);
    }

    /**
     * Say whether something arrived since the component was active last.
     *
     * @return whether {@link #fresh} has values
     */
    public boolean isFresh() {
        return !fresh.isEmpty();
    }

    Class<T> type() {
        return type;
    }

    long arrivalNs() {
        return arrivalNs;
    }

    /** Whether no value arrived since a set of inputs was complete, or since the one that arrived was given up. */
    boolean isAwaited() {
        return isAwaited;
    }

    void setAwaited(boolean isAwaited) {
        this.isAwaited = isAwaited;
    }

    void store(Object value, long timeNs) {
        T stored = type.cast(value);
        fresh.add(stored);
        latest = stored;
        arrivalNs = timeNs;
        isAwaited = false;
    }

    void stamp(long timeNs) {
        arrivalNs = timeNs;
        isAwaited = false;
    }

    void clearFresh() {
        fresh.clear();
    }
}
