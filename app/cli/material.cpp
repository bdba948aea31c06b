// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "app/cli/described_options.h"
#include "app/cli/exit_code.h"
#include "app/cli/terminal.h"
#include "app/cli/verb.h"
#include "core/solve/verdict.h"
#include "material/assets/build.h"
#include "material/assets/build_request.h"
#include "material/assets/map_set.h"
#include "material/assets/new_material.h"
#include "material/assets/watch.h"
#include "material/run/session_sets.h"

namespace weft::app {
namespace {

namespace fs = std::filesystem;

struct MaterialArguments : material::BuildRequest {
  material::NewMaterial made;
};

Result<std::vector<material::MaterialPlace>> places_of(const MaterialArguments& a) {
  std::vector<material::MaterialPlace> places;
  for (const std::string& file : a.files) {
    Result<material::MaterialPlace> place = material::find_material(file, {});
    if (!place) return std::move(place).error();
    places.push_back(std::move(*place));
  }
  return places;
}

std::string shown(const Json& value) {
  if (value.is_array() && value.size() == 1) return value[0].dump();
  return value.is_string() ? value.get<std::string>() : value.dump();
}

// Which solves a material is of, and what is stale of them.
void print_scans(const Json& scans) {
  for (const Json& scan : scans) {
    for (const std::string& line : material::source_lines(material::source_in(scan)))
      print(fmt::format("  {}: {}", scan.value("session", "scan"), line));
  }
}

Result<int> resolve(const MaterialArguments& a, const CommonArguments& common) {
  const Result<std::vector<material::MaterialPlace>> places = places_of(a);
  if (!places) return places.error();
  const Result<material::ResolvedMaterial> material =
      material::resolve_material(places->front(), material::materials_on_disk());
  if (!material) return material.error();
  const Json document = json_of(*material);
  if (common.json) {
    print_json(document);
    return kDone;
  }
  for (const Json& each : document["values"]) {
    print(fmt::format("{:28}  {:32}  {}", each["key"].get<std::string>(), shown(each["value"]),
                      each["from"].get<std::string>()));
  }
  print_scans(document["scans"]);
  return kDone;
}

Json json_of_build(const material::BuildReport& report) {
  Json materials = Json::array();
  for (const material::BuiltMaterial& each : report.materials) {
    materials.push_back({{"material", each.place.name},
                         {"name", each.document["name"]},
                         {"id", each.id},
                         {"folder", each.folder.string()},
                         {"was_there", each.was_there},
                         {"draft", each.document["draft"]},
                         {"scans", each.document["scans"]},
                         {"verdicts", each.document["verdicts"]}});
  }
  return {{"built", report.built},
          {"kept", report.kept},
          {"hashed", report.hashed},
          {"materials", std::move(materials)}};
}

void print_build(const material::BuildReport& report) {
  for (const material::BuiltMaterial& each : report.materials) {
    const Json& d = each.document;
    print(each.folder.string());
    if (each.was_there) print("  is there already: nothing that it depends on has changed");
    const std::string size = d.contains("size_mm")
                                 ? fmt::format(" of {:.5g} mm{}", d["mm_per_pixel"].get<double>(),
                                               d.value("size_known", true) ? "" : " assumed")
                                 : ", of no known size";
    print(fmt::format("  {}: {} x {} pixels{}{}", d["name"].get<std::string>(), d["width"].get<int>(),
                      d["height"].get<int>(), size, d["is_tile"].get<bool>() ? ", a tile" : ""));
    print_scans(d["scans"]);
    for (const Json& verdict : d["verdicts"])
      print(fmt::format("  {}: {}; {}", verdict["name"].get<std::string>(),
                        verdict["text"].get<std::string>(), verdict["remedy"].get<std::string>()));
  }
  print(fmt::format("{} built, {} kept", report.built, report.kept));
}

Result<material::BuildOptions> build_options(const MaterialArguments& a) {
  Result<std::vector<material::MaterialPlace>> places = places_of(a);
  if (!places) return std::move(places).error();
  return material::BuildOptions{std::move(*places), a.output, a.compose};
}

Result<int> build(const MaterialArguments& a, const CommonArguments& common) {
  const Result<material::BuildOptions> options = build_options(a);
  if (!options) return options.error();
  const Result<material::BuildReport> report = [&] {
    ProgressLine line(common.quiet);
    return material::build_materials(*options, {common.threads, stop_on_signal(), line.callback()});
  }();
  if (!report) return report.error();
  if (common.json) {
    print_json(json_of_build(*report));
  } else {
    print_build(*report);
  }
  return kDone;
}

Result<int> watch(const MaterialArguments& a, const CommonArguments& common) {
  const Result<material::BuildOptions> options = build_options(a);
  if (!options) return options.error();
  const auto tell = [&](const Result<material::BuildReport>& report) {
    if (!report) return complain(report.error());
    if (common.json) {
      print(json_of_build(*report).dump());
    } else {
      print_build(*report);
    }
    static_cast<void>(flush_output());
  };
  material::watch_materials({*options}, {.threads = common.threads, .stop = stop_on_signal()}, tell);
  return kDone;
}

Result<int> graph(const MaterialArguments& a, const CommonArguments& common) {
  const Result<std::vector<material::MaterialPlace>> places = places_of(a);
  if (!places) return places.error();
  material::DigestCache digests({});
  const Result<material::MaterialTree> tree =
      material::plan_materials(*places, material::materials_on_disk(), digests);
  if (!tree) return tree.error();
  if (common.json) {
    print_json({{"graph", material::graph_of(*tree)}});
  } else {
    print(material::graph_of(*tree));
  }
  return kDone;
}

Result<int> list(const CommonArguments& common) {
  Json materials = Json::array();
  for (const material::MaterialPlace& place : material::list_materials()) {
    const Result<material::MaterialFile> file = material::read_material(place);
    const bool has_notes = file && file->top.contains("notes");
    materials.push_back({{"name", place.name},
                         {"file", place.file.string()},
                         {"notes", has_notes ? file->top.at("notes").value : Json("")}});
    if (!file) materials.back()["error"] = file.error().message();
  }
  if (common.json) {
    print_json({{"materials", std::move(materials)}});
    return kDone;
  }
  for (const Json& each : materials)
    print(fmt::format(
        "{:26}  {}", each["name"].get<std::string>(),
        each.contains("error") ? each["error"].get<std::string>() : each["notes"].get<std::string>()));
  return kDone;
}

Result<int> show(const MaterialArguments& a, const CommonArguments& common) {
  const Result<std::vector<material::MaterialPlace>> places = places_of(a);
  if (!places) return places.error();
  const Result<std::string> text = material::material_text(places->front());
  if (!text) return text.error();
  if (common.json) {
    print_json({{"name", places->front().name}, {"text", *text}});
  } else {
    print(*text);
  }
  return kDone;
}

Result<int> make_new(const MaterialArguments& a, const CommonArguments& common) {
  const Result<void> made = material::write_new_material(a.made);
  if (!made) return made.error();
  if (common.json) {
    print_json({{"file", fs::absolute(a.made.file).string()}});
  } else {
    print(a.made.file.string());
    const Result<material::MapSet> set = material::open_map_set(a.made.scan, true);
    if (Json source = set ? source_of(*set) : Json(); !source.is_null())
      print_scans(Json::array({std::move(source)}));
  }
  return kDone;
}

void add_files(Options& options, MaterialArguments& a) {
  options.add("material", &a.files, "TOML files, or library:NAME").required();
}

Run add_new(Options& options) {
  const auto a = std::make_shared<MaterialArguments>();
  options.add("file", &a->made.file, "The file to be written, NAME.toml").required();
  options.add("--inherits", &a->made.inherits, "What it begins with: a TOML file, or library:NAME");
  options.add("--scan", &a->made.scan, "Session or folder of maps whose measured and derived maps it takes");
  options.add_flag("--draft", &a->made.is_draft, "Maps of a preview will do: writes draft = true");
  options
      .add("--layer", &a->made.layers,
           "Materials to be laid on it, bottom to top: library:dirt/dust goes into what is deep")
      .one_at_a_time();
  return [a](const CommonArguments& common) { return make_new(*a, common); };
}

Run add_resolve(Options& options) {
  const auto a = std::make_shared<MaterialArguments>();
  options.add("material", &a->files, "A TOML file, or library:NAME").required().takes(1, 1);
  return [a](const CommonArguments& common) { return resolve(*a, common); };
}

Run add_build(Options& options) {
  const auto a = std::make_shared<MaterialArguments>();
  add_options(options, static_cast<material::BuildRequest&>(*a));
  return [a](const CommonArguments& common) { return build(*a, common); };
}

Run add_watch(Options& options) {
  const auto a = std::make_shared<MaterialArguments>();
  add_options(options, static_cast<material::BuildRequest&>(*a));
  return [a](const CommonArguments& common) { return watch(*a, common); };
}

Run add_graph(Options& options) {
  const auto a = std::make_shared<MaterialArguments>();
  add_files(options, *a);
  return [a](const CommonArguments& common) { return graph(*a, common); };
}

Run add_list(Options&) {
  return [](const CommonArguments& common) { return list(common); };
}

Run add_show(Options& options) {
  const auto a = std::make_shared<MaterialArguments>();
  options.add("material", &a->files, "A TOML file, or library:NAME").required().takes(1, 1);
  return [a](const CommonArguments& common) { return show(*a, common); };
}

}  // namespace

Verb material_verb() {
  return {.name = "material",
          .help = "Materials that inherit, layer and rebuild (docs/materials.md)",
          .verbs = {
              {"new", "Write a material that begins with another, or with a scan", add_new},
              {"resolve", "Every value of a material with the file that it comes from", add_resolve},
              {"build", "Compose the maps of materials and of all that they lie on, where something changed",
               add_build},
              {"graph", "What materials depend on, for Graphviz", add_graph},
              {"watch", "Build, and again whenever a file changes, until stopped", add_watch},
              {"list", "Materials of the library: weft's own and the user's", add_list},
              {"show", "The text of a material", add_show}}};
}

}  // namespace weft::app
