// Owns the precompiled catch.hpp that all test programs share; tests nothing.
