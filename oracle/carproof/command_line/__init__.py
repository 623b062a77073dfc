"""What all commands share: options, files, tables, progress, exit codes."""
