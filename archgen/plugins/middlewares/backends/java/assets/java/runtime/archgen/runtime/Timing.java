package archgen.runtime;

import java.util.Set;

/**
 * When a component is active.
 *
 * @param mode by what
 * @param periodNs the time between two activations of {@link Mode#PERIODIC}
 * @param triggers the names of the inputs whose values make it active
 * @param withinNs how far apart the arrivals may be of {@link Mode#MATCH}
 * @param every how many values it takes for one activation
 * @param throttleNs the least time between two activations
 * @param keepsDropped whether a value that {@code every} or {@code throttleNs} drops is stored
 */
public record Timing(
        Mode mode,
        long periodNs,
        Set<String> triggers,
        long withinNs,
        long every,
        long throttleNs,
        boolean keepsDropped) {
    /** What makes a component active. */
    public enum Mode {
        /** The clock, from 0 on. */
        PERIODIC,
        /** The start, once. */
        ONCE,
        /** Each value at one of the inputs that trigger it. */
        ANY,
        /** A new value at each of the inputs that trigger it. */
        ALL,
        /** New values at all inputs that trigger it, which arrived close to one another. */
        MATCH,
        /** Nothing but calls. */
        NEVER
    }

    public Timing {
        triggers = Set.copyOf(triggers);
        if (mode == Mode.PERIODIC && periodNs <= 0 || every <= 0) {
            throw new IllegalArgumentException("a period and a number of values are positive");
        }
    }

    /**
     * Return the timing of what is active by the clock.
     *
     * @param periodNs the period
     * @return the timing
     */
    public static Timing periodic(long periodNs) {
        return new Timing(Mode.PERIODIC, periodNs, Set.of(), 0, 1, 0, true);
    }

    /**
     * Return the timing of what is active once, at the start.
     *
     * @return the timing
     */
    public static Timing once() {
        return new Timing(Mode.ONCE, 0, Set.of(), 0, 1, 0, true);
    }

    /**
     * Return the timing of what is active when it is called.
     *
     * @return the timing
     */
    public static Timing never() {
        return new Timing(Mode.NEVER, 0, Set.of(), 0, 1, 0, true);
    }

    /**
     * Return the timing of what each value at one of several inputs makes active.
     *
     * @param triggers the names of the inputs
     * @return the timing
     */
    public static Timing onAny(String... triggers) {
        return new Timing(Mode.ANY, 0, Set.of(triggers), 0, 1, 0, true);
    }

    /**
     * Return the timing of what a new value at each of several inputs makes active.
     *
     * @param triggers the names of the inputs
     * @return the timing
     */
    public static Timing onAll(String... triggers) {
        return new Timing(Mode.ALL, 0, Set.of(triggers), 0, 1, 0, true);
    }

    /**
     * Return the timing of what new values make active that arrived close to one another.
     *
     * @param withinNs how far apart they may be
     * @param triggers the names of the inputs
     * @return the timing
     */
    public static Timing onMatch(long withinNs, String... triggers) {
        return new Timing(Mode.MATCH, 0, Set.of(triggers), withinNs, 1, 0, true);
    }

    /**
     * Return the same timing for what leaves values out.
     *
     * @param newEvery how many values it takes for one activation
     * @param newThrottleNs the least time between two activations
     * @param newKeepsDropped whether what is left out is stored
     * @return the timing
     */
    public Timing dropping(long newEvery, long newThrottleNs, boolean newKeepsDropped) {
        return new Timing(mode, periodNs, triggers, withinNs, newEvery, newThrottleNs, newKeepsDropped);
    }
}
