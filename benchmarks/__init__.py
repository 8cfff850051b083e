"""Speed, accuracy and diagnosis figures; they print tables and assert nothing."""
