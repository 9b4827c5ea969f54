// Reads a CAD file with OpenCASCADE and answers with the bytes of a model. Loaded in a process of its own only: OpenCASCADE crashes on some files.
#include "io/occt/module.h"

#include <iostream>
#include <new>

#include <Message.hxx>
#include <Message_Messenger.hxx>
#include <Message_PrinterOStream.hxx>

#include "io/cad_check.h"
#include "io/cad_messages.h"
#include "io/occt/assembly.h"

namespace {

using namespace crescente;
using namespace crescente::io;

// OpenCASCADE's own printers talk to the terminal, in colour and about everything; what they print is caught by whoever started this process.
void print_warnings_only() {
    const auto& messenger = Message::DefaultMessenger();
    messenger->ChangePrinters().Clear();
    messenger->AddPrinter(new Message_PrinterOStream(Message_Warning));
}

Expected<CadModel> read(const CrescenteCadRequest& request) {
    constexpr double read_share = 0.85;
    const occt::Progress reading = [&](double fraction, const char* stage) { request.progress(request.user, fraction * read_share, stage); };
    const occt::Progress converting = [&](double fraction, const char* stage) {
        request.progress(request.user, read_share + fraction * (1 - read_share), stage);
    };
    const std::string shown = request.shown_name;
    auto document = occt::read_document(request.file, shown, reading);
    if (!document) return tl::unexpected<Error>(std::move(document.error()));
    occt::PartOptions options{request.deflection, shown, {}};
    for (std::size_t i = 0; i < request.triangulated_count; ++i) options.triangulated[request.triangulated[i].part].insert(request.triangulated[i].number);
    auto model = occt::model_of(*document, options, converting);
    if (model && !holds_together(*model)) return failure(ErrorKind::input, {shown, {}, "does not hold together: its tree is endless or its numbers are not finite", {}});
    return model;
}

}  // namespace

extern "C" __attribute__((visibility("default"))) void crescente_cad_read(const CrescenteCadRequest* request) {
    print_warnings_only();
    Expected<CadModel> result = failure(ErrorKind::internal, {request->shown_name, {}, "the module crescente_opencascade is of another version", {}});
    try {
        if (request->version == crescente_cad_version) result = read(*request);
    } catch (const std::bad_alloc&) {
        result = failure(ErrorKind::resource, {request->shown_name, {}, "needs more memory than is left", {}});
    } catch (const std::exception& error) {
        result = failure(ErrorKind::input, {request->shown_name, {}, std::string("cannot be read: ") + error.what(), {}});
    }
    std::cout.flush();
    const std::string bytes = pack_cad(result);
    request->take(request->user, bytes.data(), bytes.size());
}
