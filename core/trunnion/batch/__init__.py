"""Many parts: each programmed in a process of its own, within limits, by Dask on this computer or on a cluster; kept in a ledger."""
