"""The way into the command: signals, the named command, exit codes."""
