"""What is wrong with a log before physics is suspected."""
