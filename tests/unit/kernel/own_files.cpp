// Files of drape's own: what others have put in their places stays as it was.

#include <sys/resource.h>
#include <sys/stat.h>

#include <atomic>
#include <csignal>
#include <thread>

#include "core/app/files/file_lock.h"
#include "core/app/run/recorder_files.h"
#include "core/kernel/files/file.h"
#include "tests/support/command.h"

using namespace drape;
namespace fs = std::filesystem;

namespace {

/// A folder with a file of somebody else.
struct ForeignFile : Scratch {
  ForeignFile() { write("victim", "mine"); }
  fs::path victim() const { return path / "victim"; }
  bool untouched() const { return text_of(victim()) == "mine"; }
  std::size_t count() const {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(path), fs::directory_iterator()));
  }
};

/// No file of this process may be larger, as on a disk that is full.
struct SizeLimit {
  explicit SizeLimit(rlim_t bytes) : before(std::signal(SIGXFSZ, SIG_IGN)) {
    getrlimit(RLIMIT_FSIZE, &limit);
    const rlimit lower{bytes, limit.rlim_max};
    setrlimit(RLIMIT_FSIZE, &lower);
  }
  ~SizeLimit() {
    setrlimit(RLIMIT_FSIZE, &limit);
    std::signal(SIGXFSZ, before);
  }
  void (*before)(int);
  rlimit limit{};
};

}  // namespace

TEST_CASE("a file is written under a name that no file has, and replaces a link, not what it leads to") {
  const ForeignFile folder;
  const fs::path file = folder / "file";
  folder.write("file.part", "mine too");
  fs::create_symlink("victim", folder / "file.1.part");
  write_file(file, "first");
  CHECK(text_of(file) == "first");
  CHECK(text_of(folder / "file.part") == "mine too");
  CHECK(fs::is_symlink(folder / "file.1.part"));
  for (const bool hard : {false, true}) {
    fs::remove(file);
    if (hard)
      fs::create_hard_link(folder.victim(), file);
    else
      fs::create_symlink("victim", file);
    CHECK_THROWS_AS(write_file(file, "second", Existing::kept), WriteError);
    CHECK((fs::is_symlink(file) || fs::equivalent(file, folder.victim())));
    write_file(file, "second");
    CHECK(text_of(file) == "second");
    CHECK(folder.untouched());
  }
  CHECK(folder.count() == 4);
  struct stat status {};
  const mode_t mask = umask(0);
  umask(mask);
  REQUIRE(stat(file.c_str(), &status) == 0);
  CHECK((status.st_mode & 0777) == (0666 & ~mask));
}

TEST_CASE("of two that write a file which must be new, one succeeds") {
  const Scratch folder;
  for (int k = 0; k < 50; ++k) {
    const fs::path file = folder / std::to_string(k);
    std::atomic<int> written = 0;
    const auto attempt = [&](const char* text) {
      try {
        write_file(file, text, Existing::kept);
        ++written;
      } catch (const WriteError&) {
      }
    };
    std::thread other([&] { attempt("one"); });
    attempt("two");
    other.join();
    REQUIRE(written == 1);
    REQUIRE(text_of(file).size() == 3);
  }
}

TEST_CASE("a file that is written by several at a time is always one of theirs, whole") {
  const Scratch folder;
  std::vector<std::thread> writers;
  for (const char letter : {'a', 'b', 'c'})
    writers.emplace_back([&folder, letter] {
      for (int k = 0; k < 200; ++k) write_file(folder / "file", std::string(5000, letter));
    });
  for (std::thread& writer : writers) writer.join();
  const std::string text = text_of(folder / "file");
  CHECK(text == std::string(5000, text[0]));
  CHECK(std::distance(fs::directory_iterator(folder.path), fs::directory_iterator()) == 1);
}

TEST_CASE("a write that fails leaves neither a part nor the new name") {
  const ForeignFile folder;
  const std::string bytes(100'000, 'x');
  const SizeLimit limit(10'000);
  for (const Existing existing : {Existing::replaced, Existing::kept})
    CHECK_THROWS_WITH(write_file(folder / "file", bytes, existing),
                      "cannot write " + (folder / "file").string() + ": File too large");
  CHECK(folder.count() == 1);
}

TEST_CASE("a file that is appended to leaves another one behind a link, or of another name, as it is") {
  for (const std::string kind : {"symbolic", "hard", "none"}) {
    INFO(kind);
    const ForeignFile folder;
    const fs::path file = folder / "log";
    if (kind == "symbolic") fs::create_symlink("victim", file);
    if (kind == "hard") fs::create_hard_link(folder.victim(), file);
    if (kind == "none") folder.write("log", "mine");
    CHECK(own_file(file, 2) == file);
    CHECK(text_of(file) == "mi");
    CHECK(folder.untouched());
  }
}

TEST_CASE("a lock is taken of a file of its own alone") {
  const ForeignFile folder;
  const std::string refusal = (folder / "lock").string() + ": is not a lock of drape's; move it away";
  const auto check_refused = [&] {
    CHECK_THROWS_WITH(FileLock(folder / "lock"), refusal);
    CHECK(folder.untouched());
    fs::remove(folder / "lock");
  };
  fs::create_symlink("victim", folder / "lock");
  check_refused();
  fs::create_symlink("nowhere", folder / "lock");
  check_refused();
  CHECK_FALSE(fs::exists(folder / "nowhere"));
  fs::create_hard_link(folder.victim(), folder / "lock");
  check_refused();
  fs::copy_file(folder.victim(), folder / "lock");
  check_refused();
  REQUIRE(mkfifo((folder / "lock").c_str(), 0600) == 0);
  check_refused();
  folder.write("empty", "");
  fs::create_hard_link(folder / "empty", folder / "lock");
  check_refused();
  folder.write("lock", "");
  for (int k = 0; k < 2; ++k) {
    FileLock lock(folder / "lock");
    REQUIRE(lock.acquire(0));
    FileLock other(folder / "lock");
    CHECK_FALSE(other.acquire(0));
    CHECK(other.holder() == lock.holder());
  }
}

TEST_CASE("a link is no folder of drape's own") {
  const ForeignFile folder;
  fs::create_directory(folder / "other");
  fs::create_directory_symlink("other", folder / "levels");
  CHECK_THROWS_AS(make_folder(folder / "levels"), WriteError);
  CHECK_NOTHROW(make_folder(folder / "rest"));
}
