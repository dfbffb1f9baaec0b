"""The soft-grain benchmark set: cases, codes that run them, and what they give. See ../README.md."""
