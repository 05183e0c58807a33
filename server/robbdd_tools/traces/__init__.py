"""Store and read traces, without a simulator."""
