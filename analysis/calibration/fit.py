"""Which core.vector_registers and core.scalar_overhead bring the simulated core's counts nearest to a native build's.

Counts: {kernel: {"instructions": n, "references": n}}. The error of a kernel's figure is the logarithm of simulated over
counted; all kernels count alike, however large, as a machine is asked about each. Overhead is charged with every load and
branch, so that a kernel's instructions are a + b overhead exactly, and references do not change; registers are tried out.
"""
import math

OVERHEADS = [n / 20 for n in range(801)]  # 0 to 40


def ratios(counted, simulated, slope, overhead, figures):
    """Simulated over counted: {kernel: {figure: ratio}}. `slope`: {kernel: instructions an overhead of 1 adds}."""
    out = {}
    for kernel, real in counted.items():
        model = {"instructions": simulated[kernel]["instructions"] + overhead * slope[kernel],
                 "references": simulated[kernel]["references"]}
        out[kernel] = {f: model[f] / real[f] for f in figures}
    return out


def error(all_ratios):
    """Root mean square of the logarithms."""
    squares = [math.log(r) ** 2 for kernel in all_ratios.values() for r in kernel.values()]
    return math.sqrt(sum(squares) / len(squares))


def fit(counted, simulated, slope, figures):
    """(registers, overhead, error) with the least error. `simulated`: {registers: counts without overhead}. Of equal
    errors the fewest registers and the least overhead."""
    tried = ((error(ratios(counted, counts, slope, overhead, figures)), registers, overhead)
             for registers, counts in simulated.items() for overhead in OVERHEADS)
    least, registers, overhead = min(tried)
    return registers, overhead, least
