package archgen.runtime;

/** Something in a run went wrong: in the scenario, in a behaviour, or in how it was used. */
public final class SimulationException extends RuntimeException {
    private static final long serialVersionUID = 1L;

    /**
     * Say what went wrong.
     *
     * @param message what, and where
     */
    public SimulationException(String message) {
        super(message);
    }

    /**
     * Say what went wrong, and because of what.
     *
     * @param message what, and where
     * @param cause what a behaviour threw
     */
    public SimulationException(String message, Throwable cause) {
        super(message, cause);
    }
}
