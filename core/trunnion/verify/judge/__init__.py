"""From what was measured to what is said: proofs of setups and operations, findings, the verdict."""
