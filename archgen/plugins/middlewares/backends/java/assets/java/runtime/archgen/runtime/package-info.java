/** Runs an architecture in logical time, without middleware: the same inputs give the same trace. Made by archgen. */
package archgen.runtime;
