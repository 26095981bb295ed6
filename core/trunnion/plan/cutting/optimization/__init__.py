"""The optimiser of cutting parameters: spindle speed and feed per tooth for least time and cost under what machine and cutter bear."""
