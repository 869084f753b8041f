"""Which core.vector_registers, core.interleaved_values, core.scalar_moves and core.vector_moves bring the simulated core's
counts nearest to a native build's.

Counts: {kernel: {"instructions": n, "references": n}}. The error of a kernel's figure is the logarithm of simulated over
counted; all kernels count alike, however large, as a machine is asked about each. Moves are charged with every scalar
computation, and with every instruction of a vector computation, so that a kernel's instructions are a + b scalar + c vector
exactly, and references do not change; registers and what is interleaved are tried out.
"""
import math

SCALAR = [n / 20 for n in range(161)]  # 0 to 8
VECTOR = [n / 50 for n in range(101)]  # 0 to 2


def ratios(counted, simulated, slopes, moves, figures):
    """Simulated over counted: {kernel: {figure: ratio}}. `slopes`, `moves`: scalar and vector; of the first
    {kernel: instructions that a move adds}."""
    out = {}
    for kernel, real in counted.items():
        added = sum(slope[kernel] * move for slope, move in zip(slopes, moves))
        model = {"instructions": simulated[kernel]["instructions"] + added, "references": simulated[kernel]["references"]}
        out[kernel] = {f: model[f] / real[f] for f in figures}
    return out


def error(all_ratios):
    """Root mean square of the logarithms."""
    squares = [math.log(r) ** 2 for kernel in all_ratios.values() for r in kernel.values()]
    return math.sqrt(sum(squares) / len(squares))


def fit(counted, simulated, slopes, figures):
    """((values, scalar, vector), error) with the least error. `simulated`: {values: counts without moves}, the values being
    (registers, interleaved). Of equal errors the fewest registers and the least moves."""
    tried = ((error(ratios(counted, counts, slopes, (scalar, vector), figures)), values, scalar, vector)
             for values, counts in simulated.items() for scalar in SCALAR for vector in VECTOR)
    least, *found = min(tried)
    return tuple(found), least
