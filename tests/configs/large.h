#pragma once

#include "tests/configs/runs.h"

// For input that is large in one respect, of which the time to check it must not grow with the square.

inline const std::string rest_of_experiment = "energies: [neo_hookean, hinge]\nmethods: {newton: {}}\n";

/// `drape check e.yaml` with these options, which gets ten times the processor time that it may take, and a
/// small part of what it would take with a time that grows with the square.
inline Ended checked(const Scratch& folder, int seconds = 20, const std::string& options = "") {
  const Ended ended =
      Command("ulimit -t " + std::to_string(seconds) + "; exec " + drape_command + " check e.yaml " + options,
              folder.path)
          .wait();
  INFO(ended.err.substr(0, 1000));
  CHECK((ended.exit_code == 0 || ended.exit_code == 2));  // else a signal ended it
  return ended;
}

inline std::string repeated(int count, const std::function<std::string(int)>& line) {
  std::string text;
  for (int k = 0; k < count; ++k) text += line(k);
  return text;
}
