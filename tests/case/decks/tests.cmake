edmill_test(soft_contact_test decks/soft_contact_test.cpp)
edmill_test(wall_mesh_test decks/wall_mesh_test.cpp)
