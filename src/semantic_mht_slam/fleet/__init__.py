"""Many drives: each run on its own, their maps joined at the end. `run_drive --help` and docs/fleet.md say how."""
