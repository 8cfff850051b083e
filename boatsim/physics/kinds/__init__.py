"""What an effect may be. A kind says what it adds to a vessel's composed program; a new one is a new file here."""
