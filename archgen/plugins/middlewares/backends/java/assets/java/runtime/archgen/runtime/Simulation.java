package archgen.runtime;

import java.io.IOException;
import java.io.UncheckedIOException;
import java.util.ArrayDeque;
import java.util.Comparator;
import java.util.Deque;
import java.util.HashMap;
import java.util.List;
import java.util.Map;
import java.util.PriorityQueue;
import java.util.function.Consumer;

/** A run of an architecture in logical time. */
public final class Simulation {
    private static final int MOST_STEPS = 100_000;
    private static final int DEEPEST_CALL = 100;

    private record Due(long timeNs, int rank, long order, Runnable work) {}

    private final List<Component> components;
    private final Appendable trace;
    private final Map<String, InPort<?>> inputs = new HashMap<>();
    private final Map<String, OutPort<?>> outputs = new HashMap<>();
    private final PriorityQueue<Due> agenda =
            new PriorityQueue<>(
                    Comparator.comparingLong(Due::timeNs).thenComparingInt(Due::rank).thenComparingLong(Due::order));
    private final Deque<Runnable> steps = new ArrayDeque<>();
    private long nowNs;
    private long givenCount;
    private int callDepth;

    /**
     * Prepare a run.
     *
     * @param assembly what is run; it takes part in one run
     * @param trace gets a line for each value that is sent or arrives
     */
    public Simulation(Assembly assembly, Appendable trace) {
        this.trace = trace;
        components = assembly.components();
        assembly.sortReaders();
        long order = 0;
        for (Component component : components) {
            component.join(this);
            component.inputs().forEach(port -> inputs.put(port.id(), port));
            component.outputs().forEach(port -> outputs.put(port.id(), port));
            if (component.timing().mode() == Timing.Mode.ONCE) {
                agenda.add(new Due(0, 1, order, () -> activate(component)));
            } else if (component.timing().mode() == Timing.Mode.PERIODIC) {
                addTimer(component, 0, order);
            }
            order++;
        }
    }

    private void addTimer(Component component, long timeNs, long order) {
        agenda.add(
                new Due(
                        timeNs,
                        1,
                        order,
                        () -> {
                            addTimer(component, Math.addExact(timeNs, component.timing().periodNs()), order);
                            activate(component);
                        }));
    }

    /**
     * Let a value arrive at an input.
     *
     * @param timeNs when
     * @param input the id of the input
     * @param value the value as JSON
     */
    public void arrive(long timeNs, String input, String value) {
        InPort<?> port = inputs.get(input);
        if (port == null) {
            throw new SimulationException("there is no input " + input);
        }
        Object read = Values.read(value, port.type());
        give(timeNs, () -> deliver(port, read));
    }

    /**
     * Let an output send a value, as if its component did.
     *
     * @param timeNs when
     * @param output the id of the output
     * @param value the value as JSON
     */
    public void emit(long timeNs, String output, String value) {
        OutPort<?> port = outputs.get(output);
        if (port == null) {
            throw new SimulationException("there is no output " + output);
        }
        Object read = Values.read(value, port.type());
        give(timeNs, () -> send(port, read));
    }

    private void give(long timeNs, Runnable work) {
        if (timeNs < nowNs) {
            throw new SimulationException("it is " + nowNs + " ns already");
        }
        agenda.add(new Due(timeNs, 0, givenCount++, work));
    }

    /**
     * Run all that happens before a time.
     *
     * @param endNs the time
     */
    public void run(long endNs) {
        while (!agenda.isEmpty() && agenda.peek().timeNs() < endNs) {
            nowNs = agenda.peek().timeNs();
            while (!agenda.isEmpty() && agenda.peek().timeNs() == nowNs) {
                steps.add(agenda.poll().work());
            }
            runInstant();
        }
        nowNs = Math.max(nowNs, endNs);
    }

    private void runInstant() {
        int count = 0;
        while (!steps.isEmpty()) {
            if (++count > MOST_STEPS) {
                throw new SimulationException("at " + nowNs + " ns messages go round without end");
            }
            steps.poll().run();
        }
    }

    /**
     * Return the time of the run.
     *
     * @return nanoseconds since the start
     */
    public long nowNs() {
        return nowNs;
    }

    void send(OutPort<?> port, Object value) {
        if (!port.type().isInstance(value)) {
            throw new SimulationException(port.id() + " sends what is no " + port.type().getSimpleName());
        }
        write(">", port, value);
        for (InPort<?> reader : port.readers()) {
            steps.add(() -> deliver(reader, value));
        }
    }

    <Q, F, A> A call(Client<Q, F, A> client, Server<Q, F, A> server, Q request, Consumer<F> feedback) {
        if (callDepth >= DEEPEST_CALL) {
            throw new SimulationException("at " + nowNs + " ns calls of " + client.id() + " go round without end");
        }
        write("?", client, request);
        callDepth++;
        A answer =
                server.answer(
                        request,
                        told -> {
                            write("~", client, told);
                            feedback.accept(told);
                        });
        callDepth--;
        write("!", client, answer);
        return answer;
    }

    private void deliver(InPort<?> port, Object value) {
        write("<", port, value);
        if (port.component.activation().accept(port, value, nowNs)) {
            activate(port.component);
        }
    }

    private void activate(Component component) {
        try {
            component.fire();
        } catch (SimulationException problem) {
            throw problem;
        } catch (RuntimeException problem) {
            throw new SimulationException("at " + nowNs + " ns in " + component.id() + ": " + problem, problem);
        }
        component.inputs().forEach(InPort::clearFresh);
    }

    private void write(String mark, Port port, Object value) {
        try {
            trace.append(nowNs + " " + mark + " " + port.id() + " " + Values.write(value) + "\n");
        } catch (IOException problem) {
            throw new UncheckedIOException(problem);
        }
    }
}
