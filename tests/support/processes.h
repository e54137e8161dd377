#pragma once

#include <signal.h>
#include <sys/types.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

// What /proc says of processes. They may end at any time, and then have neither threads nor children.

inline std::string proc_text(const std::string& file) {
  std::ostringstream text;
  text << std::ifstream(file, std::ios::binary).rdbuf();
  return text.str();
}

/// The folders of a process's threads.
inline std::vector<std::string> threads_of(pid_t process) {
  std::vector<std::string> folders;
  std::error_code gone;
  const std::string all = "/proc/" + std::to_string(process) + "/task";
  for (std::filesystem::directory_iterator thread(all, gone), end; !gone && thread != end;
       thread.increment(gone))
    folders.push_back(thread->path());
  return folders;
}

inline std::vector<pid_t> children_of(pid_t process) {
  std::vector<pid_t> children;
  for (const std::string& thread : threads_of(process)) {
    std::istringstream text(proc_text(thread + "/children"));
    for (pid_t child; text >> child;) children.push_back(child);
  }
  return children;
}

/// Children first named, each before its own children.
inline std::vector<pid_t> descendants_of(pid_t process) {
  std::vector<pid_t> all;
  for (const pid_t child : children_of(process)) {
    all.push_back(child);
    for (const pid_t one : descendants_of(child)) all.push_back(one);
  }
  return all;
}

inline bool is_zombie(pid_t process) {
  const std::string stat = proc_text("/proc/" + std::to_string(process) + "/stat");
  const std::size_t state = stat.rfind(')') + 2;
  return state < stat.size() && stat[state] == 'Z';
}

/// The process's number and the words it was started with, at most 200 bytes of them.
inline std::string name_of(pid_t process) {
  std::string words = proc_text("/proc/" + std::to_string(process) + "/cmdline").substr(0, 200);
  if (words.ends_with('\0')) words.pop_back();
  std::replace(words.begin(), words.end(), '\0', ' ');
  return std::to_string(process) + " " + words;
}
