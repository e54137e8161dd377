// A shared library without the one function that makes it a plugin.

extern "C" __attribute__((visibility("default"))) int something_else() { return 1; }
