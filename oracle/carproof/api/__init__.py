"""What a script calls on values, with the checks and defaults that commands and ops have too."""
