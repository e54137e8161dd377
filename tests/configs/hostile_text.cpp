// Names and values that a terminal or a spreadsheet would act on.

#include "core/app/report/run_table.h"
#include "tests/configs/runs.h"

TEST_CASE("no command prints the control characters of a name or a file") {
  const Scratch folder(small_experiment());
  const std::string clear = "\x1b[2J\xc2\x9b";  // of seven bits and of eight
  const auto quoted = [&](const std::string& name) { return " '" + name + clear + "'"; };
  folder.write("e" + clear, text_of(folder / "e.yaml"));
  folder.write("s" + clear,
               "name: s\nbase: e.yaml\nablation: [{name: \"a\\e[2J\"}, {name: b, set: {levels: 1}}]\n");
  folder.write("f" + clear, "name,source,area_density\na" + clear + ",by \x1b[2J,0.2\n");
  folder.write("bad" + clear, "name: \"a\\e\"\n");
  const std::vector<std::string> commands = {
      "check" + quoted("e"),
      "check" + quoted("s"),
      "check" + quoted("bad"),
      "check-energy '\x1b[2J'",
      "run --levels 1" + quoted("e") + " -o" + quoted("out"),
      "run --resume" + quoted("out"),
      "run --levels 1 -q --no-report --measure" + quoted("e") + " -o" + quoted("bare"),
      "report" + quoted("out"),
      "view" + quoted("out"),
      "table" + quoted("out"),
      "table --format csv" + quoted("out"),
      "export" + quoted("out") + " --to" + quoted("state") + ".ply",
      "compare" + quoted("out") + quoted("bare"),
      "sweep --dry-run" + quoted("s") + " -o" + quoted("swept"),
      "sweep" + quoted("s") + " -o" + quoted("swept"),
      "report" + quoted("swept"),
      "table" + quoted("swept"),
      "fabric --file" + quoted("f"),
      "fabric --file" + quoted("f") + quoted("a"),
      "fabric" + quoted("none"),
      "new" + quoted("n"),
      "list" + quoted("none"),
      "describe" + quoted("none"),
      "schema" + quoted("none"),
      "help" + quoted("none"),
      "nothing" + clear,
      "run" + quoted("e") + " --method" + quoted("none"),
      "run" + quoted("e") + " --set" + quoted("a"),
      "fit" + quoted("e") + " --to 1 --by" + quoted("none")};
  for (const std::string& command : commands) {
    const Ended ended = drape_with(command, folder.path, "DISPLAY= WAYLAND_DISPLAY=");
    INFO(command << "\n" << ended.out << ended.err);
    CHECK((ended.exit_code >= 0 && ended.exit_code <= 3));
    CHECK(ended.out + ended.err != "");
    for (const char* act : {"\x1b", "\xc2\x9b"})
      CHECK((ended.out + ended.err).find(act) == std::string::npos);
  }
  CHECK(fs::exists(folder / ("out" + clear) / "report.html"));
}

TEST_CASE("a table of fabrics has the line ends of any system, and a refused cell has no wake") {
  const Scratch folder;
  folder.write("cr.csv", "name,mass,warp_bending\ra,0.3,1e-5\r");
  CHECK_THAT(shown_by("fabric a --file cr.csv", folder.path), Contains("300 g/m"));
  folder.write("quoted.csv",
               "name,mass,warp_bending,source\r\n\"a\",0.3,1e-5,\"two\r\nlines\"\r\n6\" b,0.2,1e-5,,\r\n");
  CHECK_THAT(shown_by("fabric '6\" b' --file quoted.csv", folder.path), Contains("200 g/m"));
  folder.write("bad.csv", "name,mass,warp_stiffness,weft_stiffness,warp_bending\na,0.3,1e400,5,1e-5\n");
  folder.write("e.yaml", "name: e\nmaterial: {fabric: {file: bad.csv, row: a}}\n");
  CHECK_THAT(refused_by("check e.yaml", folder.path),
             Contains("\"1e400\" in column") && !Contains("needs \"warp_stiffness\""));
}

TEST_CASE("a text that a spreadsheet would compute is marked as a text in CSV, and a number stays one") {
  using namespace drape;
  RunTable table;
  table.columns = {"run", "=sum"};
  for (const Json& value : Json::array({"=1+1", "+A1", "-A1", "@sum", "\t=1", "\r=1", "a=1", "-1.5", "",
                                        "=\"a\",b", "＝1", "＋1", "－1", "＠a"}))
    table.rows.push_back({{"run", value}, {"=sum", -1.5}});
  CHECK(table_text(table, {}, TableFormat::csv) ==
        "run,'=sum\n'=1+1,-1.5\n'+A1,-1.5\n'-A1,-1.5\n'@sum,-1.5\n'\t=1,-1.5\n\"'\r=1\",-1.5\na=1,-1.5\n-1.5,"
        "-1.5\n"
        ",-1.5\n\"'=\"\"a\"\",b\",-1.5\n'＝1,-1.5\n'＋1,-1.5\n'－1,-1.5\n'＠a,-1.5\n");
  CHECK_THAT(table_text(table, {}, TableFormat::markdown), Contains("| =1+1 |"));
  const Scratch folder(small_experiment());
  for (const std::string name : {"-2", "-A1"})
    CHECK_THAT(refused(folder, "check e.yaml --set name=" + name + "x"),
               Contains("not beginning with \".\" or \"-\""));
}
