# The generated headers, in the order of writing their files. Each is templates/NAME.mustache; edsc and edsc_add_dictionary()
# read this list.
set(EDSC_HEADERS dictionary.hpp pdo.hpp device.hpp description.hpp)
# Headers of some devices only: NAME.hpp is written if the member NAME of the view is not null.
set(EDSC_OPTIONAL_HEADERS meaning.hpp meaning_text.hpp stored_eds.hpp)
