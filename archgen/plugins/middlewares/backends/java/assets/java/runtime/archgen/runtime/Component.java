package archgen.runtime;

import java.util.ArrayList;
import java.util.List;
import java.util.function.BiFunction;
import java.util.function.Consumer;

/** A component: ports, and what it does when it is active. */
public abstract class Component {
    private final String id;
    private final Timing timing;
    private final List<InPort<?>> inputs = new ArrayList<>();
    private final List<OutPort<?>> outputs = new ArrayList<>();
    private final List<Client<?, ?, ?>> clients = new ArrayList<>();
    private final Activation activation;
    private Simulation simulation;

    /**
     * Make a component.
     *
     * @param id its id in the model
     * @param timing when it is active
     */
    protected Component(String id, Timing timing) {
        this.id = id;
        this.timing = timing;
        this.activation = new Activation(timing, inputs);
    }

    /** Do what is done when it is active. */
    protected abstract void fire();

    /**
     * Return the id in the model.
     *
     * @return the id, with those of what it stands in
     */
    public final String id() {
        return id;
    }

    /**
     * Return the time of the run.
     *
     * @return nanoseconds since the start
     */
    public final long nowNs() {
        return simulation().nowNs();
    }

    /**
     * Declare an input.
     *
     * @param <T> the type of its values
     * @param name its name in the model
     * @param type the type of its values
     * @return the port
     */
    protected final <T> InPort<T> input(String name, Class<T> type) {
        InPort<T> port = new InPort<>(this, name, type);
        inputs.add(port);
        return port;
    }

    /**
     * Declare an output.
     *
     * @param <T> the type of its values
     * @param name its name in the model
     * @param type the type of its values
     * @return the port
     */
    protected final <T> OutPort<T> output(String name, Class<T> type) {
        OutPort<T> port = new OutPort<>(this, name, type);
        outputs.add(port);
        return port;
    }

    /**
     * Declare what others may call.
     *
     * @param <Q> the type of requests
     * @param <F> the type of what is told in between
     * @param <A> the type of answers
     * @param name its name in the model
     * @param handler what answers: it gets the request, and whom to tell what happens in between
     * @return the port
     */
    protected final <Q, F, A> Server<Q, F, A> server(String name, BiFunction<Q, Consumer<F>, A> handler) {
        return new Server<>(this, name, handler);
    }

    /**
     * Declare what it calls.
     *
     * @param <Q> the type of requests
     * @param <F> the type of what is told in between
     * @param <A> the type of answers
     * @param name its name in the model
     * @return the port
     */
    protected final <Q, F, A> Client<Q, F, A> client(String name) {
        Client<Q, F, A> port = new Client<>(this, name);
        clients.add(port);
        return port;
    }

    final Timing timing() {
        return timing;
    }

    final Activation activation() {
        return activation;
    }

    final List<InPort<?>> inputs() {
        return inputs;
    }

    final List<OutPort<?>> outputs() {
        return outputs;
    }

    final List<Client<?, ?, ?>> clients() {
        return clients;
    }

    final void join(Simulation joined) {
        simulation = joined;
    }

    final Simulation simulation() {
        if (simulation == null) {
            throw new SimulationException(id + " does something before the run begins");
        }
        return simulation;
    }
}
